"""Files of superelements as scipy reads them: .npz of one matrix and of several, and Matrix Market; equal to the last bit."""
import os
import sys

import numpy as np
import scipy.io
import scipy.sparse as sp

folder = sys.argv[1]
for name in ("full", "sparse", "unsymmetric", "complex"):
    want = np.loadtxt(os.path.join(folder, name + ".txt"))
    want = (want[:, 0] + 1j * want[:, 1]).reshape(11, 11)
    single = sp.load_npz(os.path.join(folder, name + "_k.npz"))
    assert single.has_canonical_format and np.array_equal(single.toarray(), want), name
    with np.load(os.path.join(folder, name + ".npz")) as file:
        several = sp.csc_matrix((file["K_data"], file["K_indices"], file["K_indptr"]), shape=file["K_shape"])
        assert np.array_equal(several.toarray(), want), name
        assert file["dofs"].shape == (11, 2) and file["dofs"][6].tolist() == [12, 1] and file["M_format"].item() == b"csc"
    market = scipy.io.mmread(os.path.join(folder, name + "_stiffness.mtx"))
    assert np.array_equal(sp.csc_matrix(market).toarray(), want), name
sys.stdout.write("ok\n")
