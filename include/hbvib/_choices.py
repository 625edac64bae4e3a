"""Arguments that name a member of an enumeration: the member, its name in lower case, or its number."""
from __future__ import annotations

from typing import Literal, Union

from ._c import (AeroForm, BandOf, Block, Component, ContactKind, ContactState, DampingForm, DataKind, Field, Follow, LogLevel, MatrixKind,
                 Measure, Mistuning, ModeBandOf, ParameterKind, Part, Quantity, Scale, Scaling, SectorFrame, SteadyMethod, Waves)

AeroForms = Union[AeroForm, Literal["displacement", "velocity"], int]
BandOfs = Union[BandOf, Literal["amplitude", "peak_amplitude", "peak_omega"], int]
Blocks = Union[Block, Literal["own", "next", "previous"], int]
Components = Union[Component, Literal["displacement", "velocity", "acceleration"], int]
ContactKinds = Union[ContactKind, Literal["jenkins", "friction_2d", "friction_3d", "unilateral", "cubic", "regularised"], int]
ContactStates = Union[ContactState, Literal["free", "stuck", "static"], int]
DataKinds = Union[DataKind, Literal["response", "amplitude", "peak", "backbone", "linear_mode"], int]
DampingForms = Union[DampingForm, Literal["mass", "stiffness"], int]
Fields = Union[
    Field,
    Literal["omega", "amplitude", "damping_ratio", "energy", "dissipation", "residual", "newton_iterations", "error_estimate",
            "harmonics_used", "slip_fraction", "log10_amplitude", "modal_amplitude", "structural_loss", "modal_assurance",
            "sampling_error", "damping_error_estimate", "floquet_radius", "unstable_directions", "parameter_value",
            "d_amplitude", "d_damping", "free_sliders", "d_amplitude_by_place"],
    int]
Follows = Union[Follow, Literal["omega", "peak", "fold", "mode_max_damping", "peak_through_folds"], int]
LogLevels = Union[LogLevel, Literal["none", "warn", "info", "debug"], int]
MatrixKinds = Union[
    MatrixKind, Literal["mass", "damping", "stiffness", "structural", "gyroscopic", "stiffness_speed2"], int]
Measures = Union[Measure, Literal["fundamental", "harmonic", "peak", "rms", "range"], int]
Mistunings = Union[Mistuning, Literal["stiffness", "frequency", "mass", "damping", "preload", "force"], int]
ModeBandOfs = Union[ModeBandOf, Literal["damping", "omega"], int]
ParameterKinds = Union[
    ParameterKind,
    Literal["force", "preload", "mu", "kt", "kn", "gap", "mass", "damping", "stiffness", "speed", "slider_t1",
            "slider_t2"],
    int]
Parts = Union[
    Part,
    Literal["full", "lower", "upper", "general", "symmetric", "symmetric_lower", "symmetric_upper"], int]
Quantities = Union[
    Quantity,
    Literal["amplitude", "peak_amplitude", "peak_omega", "mode_omega", "mode_damping", "response", "response_peak_omega"], int]
Scales = Union[Scale, Literal["automatic", "linear", "log"], int]
Scalings = Union[Scaling, Literal["additive", "factor"], int]
SectorFrames = Union[SectorFrame, Literal["cartesian", "cylindrical"], int]
SteadyMethods = Union[SteadyMethod, Literal["shooting", "marching"], int]
WaveSets = Union[Waves, Literal["wave", "wheel"], int]
