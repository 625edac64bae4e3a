"""
Steady-state vibration of structures with friction contacts, by harmonic balance: M x'' + C x' + K x + f_contact(x) = f_excitation.

    model = Hbvib.Model(mass = [1.0;;], stiffness = [1.0;;], rayleigh = (0, 0.02))
    Hbvib.add_contact!(model, :JENKINS, 1; kt = 1, mu = 0.3, preload = 1)
    Hbvib.add_force!(model, 1, 0.2)
    branch = Hbvib.forced_response(model, (0.8, 1.6))
    Hbvib.peaks(branch).omega

Degrees of freedom, contacts and points count from 1 here, and from 0 in the functions of C, all of which are in this module by their
names. The library is libhbvib on the path of the loader, or the file that the variable HBVIB_LIBRARY names.
"""
module Hbvib

using Libdl
using SparseArrays

const GROUND = -1
const library = Ref{Ptr{Cvoid}}(C_NULL)

function __init__()
    library[] = dlopen(get(ENV, "HBVIB_LIBRARY", "libhbvib"))
end

dlsym_(name::Symbol) = dlsym(library[], name)

"A negative status, with its name and the sentence of the library."
struct Error <: Exception
    status::Int32
    name::String
    sentence::String
end
Base.showerror(io::IO, e::Error) = print(io, e.name, ": ", e.sentence)

"A struct with the defaults of the library."
function initialised(::Type{T}, init) where {T}
    made = Ref{T}()
    check(ccall(init, Int32, (Ptr{T}, Csize_t), made, sizeof(T)))
    made[]
end

"A copy of a struct with some fields changed."
function with(s::T; changes...) where {T}
    given = Dict(changes)
    for name in keys(given)
        name in fieldnames(T) || throw(ArgumentError("$T has no $name, needs one of $(join(fieldnames(T), ", "))"))
    end
    T((convert(fieldtype(T, name), get(given, name, getfield(s, name))) for name in fieldnames(T))...)
end

include("raw.jl")

function check(status)
    status < 0 && throw(Error(status, unsafe_string(hbvib_status_name(status)), unsafe_string(hbvib_last_error())))
    status
end

"The index from 0, or an error in numbers from 1."
function zero_based(name, index, count)
    index == GROUND && return Int64(GROUND)
    out = Ref{Int64}()
    check(hbvib_index_from_one(name, index, count, out))
    out[]
end

"A structure with its contacts and forces; freed with its last reference."
mutable struct Model
    handle::Ptr{Cvoid}
    function Model(handle::Ptr{Cvoid})
        model = new(handle)
        finalizer(m -> hbvib_model_free(m.handle), model)
    end
end

function Model(; mass, stiffness, damping = nothing, rayleigh = nothing)
    out = Ref{Ptr{Cvoid}}(C_NULL)
    check(hbvib_model_new(size(mass, 1), out))
    model = Model(out[])
    for (kind, matrix) in ((HBVIB_MASS, mass), (HBVIB_STIFFNESS, stiffness), (HBVIB_DAMPING, damping))
        matrix === nothing || set_matrix!(model, kind, matrix)
    end
    rayleigh === nothing || check(hbvib_model_set_rayleigh(model.handle, rayleigh[1], rayleigh[2]))
    model
end

ndof(model::Model) = check(hbvib_model_dofs(model.handle))

"Sets a matrix, HBVIB_MASS, HBVIB_DAMPING, HBVIB_STIFFNESS ..., dense or sparse, real or complex."
function set_matrix!(model::Model, kind, matrix::AbstractMatrix; part = HBVIB_FULL)
    number = eltype(matrix) <: Complex ? ComplexF64 : Float64
    dense = Matrix{number}(undef, 0, 0)
    starts, rows, values = Int64[], Int64[], number[]
    if issparse(matrix)
        starts, rows, values = Int64.(matrix.colptr), Int64.(matrix.rowval), number.(matrix.nzval)
    else
        dense = Matrix{number}(matrix)
    end
    numbers = issparse(matrix) ? values : dense
    GC.@preserve starts rows numbers begin
        view = with(hbvib_matrix(); rows = size(matrix, 1), cols = size(matrix, 2), part = part,
            scalar = number == Float64 ? HBVIB_REAL : HBVIB_COMPLEX, values = Ptr{Float64}(pointer(numbers)))
        if issparse(matrix)
            view = with(view; storage = HBVIB_CSC, col_ptr = pointer(starts), row_idx = pointer(rows), index_base = 1)
        end
        check(hbvib_model_set_matrix(model.handle, kind, Ref(view)))
    end
    nothing
end

"Adds Re(force exp(i harmonic omega t)) on a degree of freedom."
add_force!(model::Model, dof, force; harmonic = 1) =
    check(hbvib_model_add_force(model.handle, zero_based("dof", dof, ndof(model)), harmonic, real(force), imag(force)))

"Adds a contact by the name of its constant, :JENKINS ..., and returns its number; a and b are degrees of freedom or tuples (t1, t2, n)."
function add_contact!(model::Model, kind::Symbol, a, b = GROUND; constants...)
    places(name, side) = ntuple(i -> i <= length(side) ? zero_based(name, side[i], ndof(model)) : Int64(GROUND), 3)
    law = with(hbvib_contact(); kind = getfield(@__MODULE__, Symbol(:HBVIB_, kind)), dof_a = places("a", a), dof_b = places("b", b),
        constants...)
    id = Ref{Int64}()
    check(hbvib_model_add_contact(model.handle, Ref(law), id))
    id[] + 1
end

"Solutions along a curve; freed with its last reference. A child keeps its parent, which frees it."
mutable struct Branch
    handle::Ptr{Cvoid}
    status::Int32
    parent::Union{Nothing, Branch}
    function Branch(handle::Ptr{Cvoid}, status)
        branch = new(handle, status, nothing)
        finalizer(b -> hbvib_branch_free(b.handle), branch)
    end
    Branch(handle::Ptr{Cvoid}, status, parent::Branch) = new(handle, status, parent)
end

function solver_options(given)
    chosen = Dict{Symbol, Any}(given)
    haskey(chosen, :harmonics) && get!(chosen, :tolerance, 0.0)
    with(hbvib_solver_options(); chosen...)
end

"""
Follows the periodic response over (start, stop); options are those of hbvib_solver_options. With branches = 1 to 4 solutions beside it are
sought, at most most_branches of branch_depth generations, which children gives.
"""
function forced_response(model::Model, omega; branches = 0, branch_depth = 0, most_branches = 0, solver...)
    range = with(hbvib_forced_options(); omega_start = first(omega), omega_stop = last(omega), branches = branches,
        branch_depth = branch_depth, most_branches = most_branches)
    out = Ref{Ptr{Cvoid}}(C_NULL)
    status = check(hbvib_forced_response(model.handle, Ref(solver_options(solver)), Ref(range), C_NULL, out))
    Branch(out[], status)
end

"""
Follows a nonlinear mode over (start, stop) of log10 of the modal amplitude; mode counts from 1. With branches = 1 the curves that branch
off from it are sought, which children gives.
"""
function nonlinear_mode(model::Model, log10_amplitude; mode = 1, branches = 0, branch_depth = 0, most_branches = 0, solver...)
    options = with(hbvib_mode_options(); log10_start = first(log10_amplitude), log10_stop = last(log10_amplitude),
        mode_index = zero_based("mode", mode, ndof(model)), branches = branches, branch_depth = branch_depth,
        most_branches = most_branches)
    out = Ref{Ptr{Cvoid}}(C_NULL)
    status = check(hbvib_nonlinear_mode(model.handle, Ref(solver_options(solver)), Ref(options), C_NULL, out))
    Branch(out[], status)
end

"A field over the points of the curve, HBVIB_OMEGA ..., as a copy."
function field(branch::Branch, kind)
    view = Ref(hbvib_view())
    check(hbvib_branch_field(branch.handle, kind, view))
    v = view[]
    [unsafe_load(v.data, 1 + (i - 1) * v.stride[1]) for i in 1:v.shape[1]]
end

omega(branch::Branch) = field(branch, HBVIB_OMEGA)
amplitude(branch::Branch) = field(branch, HBVIB_AMPLITUDE)

"Refined peaks: omega, amplitude, point."
function peaks(branch::Branch)
    count = Ref{Int64}()
    check(hbvib_branch_peaks(branch.handle, 0, C_NULL, C_NULL, C_NULL, count))
    omega, amplitude, point = zeros(count[]), zeros(count[]), zeros(Int64, count[])
    check(hbvib_branch_peaks(branch.handle, count[], omega, amplitude, point, count))
    (omega = omega, amplitude = amplitude, point = point .+ 1)
end

"Bifurcations: omega, amplitude, kind (HBVIB_BIFURCATION_FOLD ...), point, unstable directions before and after (-1 where unknown)."
function bifurcations(branch::Branch)
    count = Ref{Int64}()
    check(hbvib_branch_bifurcations(branch.handle, 0, C_NULL, C_NULL, C_NULL, C_NULL, C_NULL, C_NULL, count))
    n = count[]
    omega, amplitude = zeros(n), zeros(n)
    kind, point, before, after = zeros(Int64, n), zeros(Int64, n), zeros(Int64, n), zeros(Int64, n)
    check(hbvib_branch_bifurcations(branch.handle, n, omega, amplitude, kind, point, before, after, count))
    (omega = omega, amplitude = amplitude, kind = kind, point = point .+ 1, unstable_before = before, unstable_after = after)
end

"The branches that branch off from this one, and detached curves beside it, as far as branches sought them; each has children of its own."
function children(branch::Branch)
    map(1:check(hbvib_branch_children(branch.handle))) do number
        out = Ref{Ptr{Cvoid}}(C_NULL)
        check(hbvib_branch_child(branch.handle, number - 1, out))
        Branch(out[], hbvib_branch_status(out[]), branch)
    end
end

"Where a child comes from: kind, periods, merges_at ... of hbvib_descent; bifurcation and mode count from 1, -1 is none."
function descent(branch::Branch)
    found = Ref(hbvib_descent())
    check(hbvib_branch_descent(branch.handle, found))
    from_one(index) = index < 0 ? index : index + 1
    with(found[]; bifurcation = from_one(found[].bifurcation), mode = from_one(found[].mode))
end

"The solutions beside a branch that were sought, hbvib_searched; the list of children is never complete."
function searched(branch::Branch)
    found = Ref(hbvib_searched())
    check(hbvib_branch_searched(branch.handle, found))
    found[]
end

"The model for motions with some periods of its forces, as those of children with descent(child).periods > 1."
function longer_period(model::Model, periods)
    out = Ref{Ptr{Cvoid}}(C_NULL)
    check(hbvib_model_longer_period(model.handle, periods, out))
    Model(out[])
end

"Harmonics 0 .. H at a point, ndof x (H + 1) complex."
function harmonics(branch::Branch, point)
    size_ = Ref(hbvib_reduction())
    check(hbvib_branch_reduction(branch.handle, size_))
    n, h = size_[].degrees_of_freedom, size_[].harmonics_asked
    x = zeros(ComplexF64, n, h + 1)
    GC.@preserve x check(hbvib_branch_harmonics(branch.handle, zero_based("point", point, hbvib_branch_stored(branch.handle)), 0, n,
        Ptr{Float64}(pointer(x)), length(x)))
    x
end

end
