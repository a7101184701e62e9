"""Yang, Liu, Luo, Yu and Chen (2022): parameters, printed claims and known misprints, as data.

Only what the paper prints stands here, never a computed value. The printed equations are in `yang2022_equations`.
"""

from __future__ import annotations

from dataclasses import dataclass

TITLE = (
    "The Parameter Design of Nonlinear Energy Sink Installed on the Jacket Pipe by Using the Nonlinear Dynamical Theory"
)
AUTHORS = ("Lianfeng Yang", "Liqin Liu", "Chao Luo", "Yongjun Yu", "Yiqun Chen")
JOURNAL = "Applied Sciences 12 (2022) 7272"
DOI = "10.3390/app12147272"


@dataclass(frozen=True)
class PipeData:
    """Table 1 and the text of section 4.1.

    Parameters
    ----------
    mass : float
        [kg]; per metre of pipe, since the lift of Eq. 2 is a force per metre.
    natural_frequency_hz : float
        [Hz].
    damping_ratio : float
        [-].
    diameter : float
        [m].
    air_density : float
        [kg/m^3].
    wind_speeds : tuple of float
        Range of the wind speed [m/s].
    wind_speed : float
        The speed the lift coefficient and Strouhal number hold for [m/s].
    lift_coefficient, strouhal : float
        C_L and St [-].
    """

    mass: float = 247.0
    natural_frequency_hz: float = 0.78
    damping_ratio: float = 0.0015
    diameter: float = 0.762
    air_density: float = 1.225
    wind_speeds: tuple[float, float] = (2.5, 3.1)
    wind_speed: float = 2.7
    lift_coefficient: float = 0.4535
    strouhal: float = 0.225


PIPE = PipeData()


@dataclass(frozen=True)
class Sink:
    """A nonlinear energy sink of the paper, normalised by the pipe's mass.

    Parameters
    ----------
    kappa : float
        Cubic stiffness k_nes/m1 [1/(m^2 s^2)].
    xi2 : float
        Damping c_nes/m1 [1/s].
    rho2 : float
        Mass ratio m_nes/m1 [-].
    """

    kappa: float
    xi2: float = 0.0085
    rho2: float = 0.02


SOFT, MIDDLE, STIFF = Sink(24.425), Sink(97.97), Sink(367.38)
STIFF_LESS_DAMPED, STIFF_MORE_DAMPED = Sink(367.38, xi2=0.0044), Sink(367.38, xi2=0.0117)
SOFT_LESS_DAMPED, SOFT_MORE_DAMPED = Sink(24.425, xi2=0.0044), Sink(24.425, xi2=0.0117)


@dataclass(frozen=True)
class Tolerance:
    """How near a computed value must be to count as agreeing.

    Parameters
    ----------
    absolute, relative : float
        Allowed difference, in the unit of the value and as a fraction of it; the larger of both counts.
    reason : str
        Why so much.
    upper_bound : bool
        Whether the printed value is a bound, so that everything below it agrees.
    """

    absolute: float
    relative: float
    reason: str
    upper_bound: bool = False

    def allows(self, printed: float, computed: float) -> bool:
        """Whether `computed` is within this tolerance of `printed`."""
        if self.upper_bound and computed <= printed:
            return True
        return abs(computed - printed) <= max(self.absolute, self.relative * abs(printed))


READ_OFF = Tolerance(0.005, 0.0, "bounds of a range, read off a curve drawn through separate detunings")
ONE_DIGIT = Tolerance(0.05, 0.0, "printed with one digit: half a unit of it")
PEAK = Tolerance(0.0, 0.02, "largest value on a grid of detunings, printed with three digits")
APPROXIMATE = Tolerance(0.0, 0.1, "the text says 'approximately' or 'reaches'")
THREE_DIGITS = Tolerance(0.0, 0.003, "the Strouhal number is printed with three digits")
PEAK_RATIO = Tolerance(0.05, 0.04, "half a unit of the last printed digit; two largest values, each good to 2 %")
UPPER_BOUND = Tolerance(0.0, 0.0, "the text says 'below' or 'less than'", upper_bound=True)


@dataclass(frozen=True)
class PrintedValue:
    """One printed number.

    Parameters
    ----------
    name : str
        Which quantity it is.
    value : float
        As printed, in SI units.
    unit : str
    tolerance : Tolerance
    """

    name: str
    value: float
    unit: str
    tolerance: Tolerance


@dataclass(frozen=True)
class Claim:
    """A statement of the paper that a computation can confirm or refute.

    Parameters
    ----------
    id : int
        Number of the claim.
    figure : str
        Figure or section of the paper.
    statement : str
        What the paper says, in one sentence.
    quantity : str
        What to compute to judge it.
    sinks : tuple of Sink
        The sinks it is about, in the order of the statement; empty for the pipe alone.
    detuning : float or None
        sigma [rad/s] where the statement names one.
    printed : tuple of PrintedValue
        Printed numbers; empty where the statement is a yes or no.
    statements : tuple of str
        What the sentence says besides numbers: each can only hold or not.
    """

    id: int
    figure: str
    statement: str
    quantity: str
    sinks: tuple[Sink, ...] = ()
    detuning: float | None = None
    printed: tuple[PrintedValue, ...] = ()
    statements: tuple[str, ...] = ()


def _range(name: str, low: float, high: float) -> tuple[PrintedValue, PrintedValue]:
    return tuple(  # type: ignore[return-value]
        PrintedValue(f"{name} {end}", value, "rad/s", READ_OFF) for end, value in (("from", low), ("to", high))
    )


def _length(name: str, value: float, tolerance: Tolerance) -> PrintedValue:
    return PrintedValue(name, value, "m", tolerance)


CLAIMS = (
    Claim(
        1, "section 4.1", "At a wind of 2.7 m/s the shedding frequency is 0.796 Hz.",
        "St U / D", printed=(PrintedValue("shedding frequency", 0.796, "Hz", THREE_DIGITS),),
    ),
    Claim(
        2, "6", "At kappa 24.425 the response is one stable branch; its largest amplitudes are 0.0557 m and 0.0493 m.",
        "largest amplitudes over the detuning (the two numbers are exchanged in print)", (SOFT,),
        printed=(_length("pipe", 0.0557, PEAK), _length("relative", 0.0493, PEAK)),
        statements=("one response at every detuning", "it is stable everywhere"),
    ),
    Claim(
        3, "5", "At kappa 97.97 the periodic response is unstable for sigma in [0, 0.024].",
        "range of detuning with an unstable response", (MIDDLE,), printed=_range("unstable", 0.0, 0.024),
    ),
    Claim(
        4, "5, 6", "The peak at kappa 24.425 is approximately 1.7 times the peak at kappa 97.97.",
        "ratio of the largest pipe amplitudes", (SOFT, MIDDLE),
        printed=(PrintedValue("peak ratio", 1.7, "-", PEAK_RATIO),),
    ),
    Claim(
        5, "7", "At kappa 367.38 several responses exist for sigma in [-0.164, -0.1].",
        "range between the saddle-nodes left of resonance", (STIFF,), printed=_range("several responses", -0.164, -0.1),
    ),
    Claim(
        6, "7", "At kappa 367.38 the response is quasi-periodic for sigma in [-0.012, 0.13].",
        "range of detuning with an unstable response", (STIFF,), printed=_range("unstable", -0.012, 0.13),
    ),
    Claim(
        7, "7", "At kappa 367.38 the saddle-node right of resonance begins at sigma 0.068.",
        "lowest saddle-node right of resonance", (STIFF,),
        printed=(PrintedValue("saddle-node", 0.068, "rad/s", READ_OFF),),
    ),
    Claim(
        8, "8", "From rest at sigma -0.144 both amplitudes are approximately 0.0045 m.",
        "amplitudes of the response reached from rest", (STIFF,), -0.144,
        (_length("pipe", 0.0045, APPROXIMATE), _length("relative", 0.0045, APPROXIMATE)),
    ),
    Claim(
        9, "8", "On the upper branch at sigma -0.144 the amplitudes reach 0.025 m and approximately 0.05 m.",
        "amplitudes of the largest stable response", (STIFF,), -0.144,
        (_length("pipe", 0.025, APPROXIMATE), _length("relative", 0.05, APPROXIMATE)),
    ),
    Claim(
        10, "8", "The initial state (3, 3, 3, 3) leads to the upper branch at sigma -0.144.",
        "response reached from (x1, x1', x2, x2') = (3, 3, 3, 3) in metres and metres per second", (STIFF,), -0.144,
        statements=("the upper branch is reached",),
    ),
    Claim(
        11, "9", "At kappa 367.38 and sigma 0 the pipe moves approximately 20 % of what it does without a sink.",
        "largest pipe displacement over the amplitude without a sink", (STIFF,), 0.0,
        (PrintedValue("ratio", 0.2, "-", APPROXIMATE),),
    ),
    Claim(
        12, "10", "At xi2 0.0044 several responses exist for sigma in [-0.34, -0.088]; the largest pipe amplitude is"
        " approximately 0.075 m at sigma -0.1.",
        "range between the saddle-nodes left of resonance, and the peak with its detuning", (STIFF_LESS_DAMPED,),
        printed=(
            *_range("several responses", -0.34, -0.088), _length("pipe", 0.075, APPROXIMATE),
            PrintedValue("detuning of the peak", -0.1, "rad/s", ONE_DIGIT),
        ),
    ),
    Claim(
        13, "10", "At xi2 0.0044 saddle-nodes and Hopf points still exist for sigma in [0.056, 0.288].",
        "first and last special point right of resonance", (STIFF_LESS_DAMPED,),
        printed=_range("special points", 0.056, 0.288),
    ),
    Claim(
        14, "11", "At xi2 0.0117 the saddle-nodes left of resonance have disappeared, the motion is unstable for sigma"
        " in [-0.016, 0.084], and the pipe stays below 0.02 m.",
        "saddle-nodes left of resonance; range with an unstable response; largest pipe amplitude", (STIFF_MORE_DAMPED,),
        printed=(*_range("unstable", -0.016, 0.084), _length("pipe, at most", 0.02, UPPER_BOUND)),
        statements=("no saddle-node left of resonance",),
    ),
    Claim(
        15, "12", "More damping shrinks the unstable range at kappa 367.38; at kappa 24.425 it lowers the peak, and the"
        " response is stable.",
        "unstable ranges of the first three sinks, peaks and stability of the others",
        (STIFF_LESS_DAMPED, STIFF, STIFF_MORE_DAMPED, SOFT_LESS_DAMPED, SOFT, SOFT_MORE_DAMPED),
        statements=(
            "the unstable range shrinks at kappa 367.38", "the peak falls at kappa 24.425",
            "the response is stable at kappa 24.425",
        ),
    ),
    Claim(
        16, "3, 4", "At kappa 97.97 the motion beats, the relative motion is much larger than the pipe's, and its"
        " energy lies near 0.78 Hz.",
        "time histories and spectra from rest", (MIDDLE,), 0.0,
        (PrintedValue("dominant frequency", 0.78, "Hz", APPROXIMATE),),
        statements=("the motion beats", "the relative motion is much larger than the pipe's"),
    ),
    Claim(
        17, "9", "The stiffer the sink, the less the pipe moves.",
        "largest pipe amplitude of each sink", (SOFT, MIDDLE, STIFF),
        statements=("the stiffer the sink, the less the pipe moves",),
    ),
    Claim(
        18, "10", "At xi2 0.0044 and sigma 0 there is only one equilibrium and it is unstable; right of resonance the"
        " pipe stays below 0.02 m.",
        "number and stability of the responses at sigma 0; largest pipe amplitude for sigma > 0",
        (STIFF_LESS_DAMPED,), 0.0, (_length("pipe, at most", 0.02, UPPER_BOUND),),
        ("one equilibrium", "it is unstable"),
    ),
    Claim(
        19, "9, 11", "Right of resonance the range with several responses is smaller at xi2 0.0117 than at 0.0085.",
        "range between the saddle-nodes right of resonance", (STIFF_MORE_DAMPED, STIFF),
        statements=("the range is smaller",),
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Misprint:
    """Something printed that cannot be meant.

    Parameters
    ----------
    where : str
        Equation or section.
    printed, corrected : str
        As printed, and what it must be.
    reason : str
        How one knows.
    """

    where: str
    printed: str
    corrected: str
    reason: str


_LACKING = "left out in Eqs. 16, A1 and A2 alike; Eqs. 18 and 20 have it"
_SUBSCRIPT = "differs from the derivation by one symbol"

MISPRINTS = (
    Misprint("Eq. 3", "k = k_nes/m1", "kappa = k_nes/m1", "every later equation uses kappa"),
    Misprint("Eqs. 5-9", "D_i (i = 1, 2)", "D_i (i = 0, 1)", "the equations use D0 and D1"),
    Misprint(
        "Eq. 14", "x12 = 1/8 kappa A^3 e^{3 i omega t1}", "x12 = -kappa B1^3 e^{3 i Omega t0} / (8 omega^2)",
        "x12 answers the third harmonic of kappa z11^3, and t1 is the slow time",
    ),
    Misprint("Eq. 16", "no term in A", "- rho2 omega^2 A", "Eq. 12 plus Eq. 15 contains it, and so do Eqs. 18 and 20"),
    Misprint(
        "Eq. 18, row 3", "rho2 a' omega cos(gamma1)", "rho2 a' omega sin(gamma1)",
        "real part of i a' e^{i gamma1}",
    ),
    Misprint("Eq. 18, row 3", "+ xi2 b'/2", "- xi2 b'/2", "beside rho2 b beta' omega it must be negative"),
    Misprint(
        "section 3.2", "Equation (22) is substituted into Equations (15) and (16)", "into Equations (13) and (16)",
        "Eq. 15 contains B2, and A' comes from Eq. 13",
    ),
    Misprint("Eq. A1, p2'", "8 p1 rho2^2 xi2 omega^2", "8 p2 rho2^2 xi2 omega^2", f"{_SUBSCRIPT}; J22 has it right"),
    Misprint(
        "Eq. A1, p2'", "no such terms", "- (8 rho2^2 omega^3 q1 + 4 rho2 xi2 omega^2 p1) in the bracket", _LACKING
    ),
    Misprint("Eq. A1, q2'", "6 kappa p2^2 rho2^2 omega", "6 kappa p2^3 rho2^2 omega", _SUBSCRIPT),
    Misprint(
        "Eq. A1, q2'", "no such terms", "4 rho2 xi2 omega^2 q1 - 8 rho2^2 omega^3 p1 in the bracket", _LACKING
    ),
    Misprint(
        "Eq. A2", "J(p1, q1, p2, q2)", "J(p1, p2, q1, q2)", "rows and columns are in this order"
    ),
    Misprint("Eq. A2, J21", "no such term", "+ rho2 xi2 omega^2 in the numerator", _LACKING),
    Misprint("Eq. A2, J22", "9 kappa q2^2 xi2", "9 kappa p2^2 xi2", _SUBSCRIPT),
    Misprint("Eq. A2, J23", "no such term", "+ 2 rho2^2 omega^3 in the numerator", _LACKING),
    Misprint("Eq. A2, J24", "4 xi2^2 sigma (twice)", "4 xi2^2 sigma and 4 xi2^2 omega", _SUBSCRIPT),
    Misprint("Eq. A2, J41", "no such term", "- 2 rho2^2 omega^3 in the numerator", _LACKING),
    Misprint("Eq. A2, J42", "18 kappa q2^2 rho2 omega", "18 kappa p2^2 rho2 omega", _SUBSCRIPT),
    Misprint("Eq. A2, J42", "6 kappa p2 rho2 q2^2 xi2", "6 kappa p2 rho2 q2 xi2", _SUBSCRIPT),
    Misprint("Eq. A2, J43", "no such term", "+ rho2 xi2 omega^2 in the numerator", _LACKING),
    Misprint(
        "section 4.2.1, kappa = 24.425", "pipe 0.0557 m, relative displacement 0.0493 m",
        "pipe 0.0493 m, relative displacement 0.0557 m", "Eq. 12 relates the two amplitudes and allows only this order",
    ),
)  # fmt: skip
