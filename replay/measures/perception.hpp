#pragma once

/// What a hand can tell apart, as far as compare judges by it. Sources and how far they carry:
/// docs/replay.md. All of it is of people on average.
namespace irdm::replay::perception {

/// Smallest difference of a force that is noticed, as a share of the force. Pang, Tan and Durlach
/// 1991 (Perception & Psychophysics 49(6)): about 7 % from 2.5 to 10 N; 10 % is the usual round
/// figure.
inline constexpr double kForceShare = 0.10;
/// Smaller forces are judged like this one [N]: there the share grows. Ours, not measured.
inline constexpr double kSmallForce = 0.5;
/// Forces are averaged over this time [s] before they are judged so; what is faster is vibration.
/// Ours.
inline constexpr double kForceTime = 0.1;

/// The same of a compliance. Tan, Pang and Durlach 1992 (ASME DSC 42): 5 to 15 %; Tan, Durlach,
/// Beauregard and Srinivasan 1995 (Perception & Psychophysics 57(4)): 22 % without work and
/// terminal force to go by.
inline constexpr double kComplianceShare = 0.15;

/// Two taps on the skin with less between them [s] are felt as one (Gescheider 1974; Sherrick and
/// Cholewiak 1986, Handbook of Perception and Human Performance).
inline constexpr double kOnsetDelay = 0.0055;

/// Smallest amplitude (peak) of a vibration of the skin that is felt [m], at a frequency [Hz]:
/// Verrillo 1963 (J. Acoust. Soc. Am. 35), thenar eminence, contactor of 2.9 cm^2, in straight
/// lines. Flat up to 40 Hz, from there 12 dB an octave down to 0.1 um at 250 Hz, where the Pacinian
/// channel feels best. Above that, where it rises again, it is held at 0.1 um.
double vibration_threshold(double frequency) noexcept;
inline constexpr double kLowestVibration = 40.0;  ///< [Hz]: below it is not the Pacinian channel

/// What holds the stylus: a mass on spring and damper, as the virtual hand of irdm-bridge.
struct Hand {
  double mass = 0.12;        ///< with the device's [kg]
  double damping = 2.0;      ///< [N s/m]
  double stiffness = 300.0;  ///< [N/m]
};

/// Amplitude of its motion per amplitude of the force on it [m/N], at a frequency [Hz].
double hand_compliance(const Hand& hand, double frequency) noexcept;

}  // namespace irdm::replay::perception
