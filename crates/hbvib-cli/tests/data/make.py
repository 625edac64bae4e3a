"""Decks of CalculiX whose matrices are beside this file: python3 make.py, then ccx beam, ccx block, ccx other (block_other.mas is
its mass)."""

def bricks(name, nx, ny, nz, size, wedge):
    ids={}; lines=['*NODE, NSET=ALL']
    n=0
    for k in range(nz+1):
        for j in range(ny+1):
            for i in range(nx+1):
                n+=1; ids[i,j,k]=n
                x=size*i*(1+0.05*j); y=size*j*(1+0.03*k); z=size*k*(1-0.04*i)
                lines.append('%d, %.10g, %.10g, %.10g'%(n,x,y,z))
    if wedge:
        lines.append('*ELEMENT, TYPE=C3D4, ELSET=E')
        e=0
        for k in range(nz):
            for j in range(ny):
                for i in range(nx):
                    c=[ids[i+a,j+b,k+d] for d in (0,1) for b in (0,1) for a in (0,1)]
                    for t in ((0,1,3,7),(0,3,2,7),(0,2,6,7),(0,6,4,7),(0,4,5,7),(0,5,1,7)):
                        e+=1; lines.append('%d, %d, %d, %d, %d'%(e,*[c[q] for q in t]))
    else:
        lines.append('*ELEMENT, TYPE=C3D8, ELSET=E')
        e=0
        for k in range(nz):
            for j in range(ny):
                for i in range(nx):
                    e+=1
                    c=[ids[i,j,k],ids[i+1,j,k],ids[i+1,j+1,k],ids[i,j+1,k],ids[i,j,k+1],ids[i+1,j,k+1],ids[i+1,j+1,k+1],ids[i,j+1,k+1]]
                    lines.append('%d, '%e+', '.join(map(str,c)))
    fixed=[ids[0,j,k] for j in range(ny+1) for k in range(nz+1)]
    lines+=['*NSET, NSET=WALL',', '.join(map(str,fixed[:12]))]
    lines+=['*MATERIAL, NAME=STEEL','*ELASTIC','2.1e11, 0.3','*DENSITY','7850','*SOLID SECTION, ELSET=E, MATERIAL=STEEL','*BOUNDARY','WALL, 1, 3','*STEP','*FREQUENCY, SOLVER=MATRIXSTORAGE','1','*END STEP']
    open(name+'.inp','w').write('\n'.join(lines)+'\n')
bricks('beam',5,1,1,0.01,False)
bricks('block',3,2,1,0.02,True)
bricks('other',2,2,2,0.02,False)
