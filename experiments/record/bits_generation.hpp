#pragma once

namespace ballast {

/// Which generation of bits the results belong to: within one, the same scene gives the same bits.
/// Raised by one when a change is meant to give other bits; tests/golden is then made anew.
/// record.h5 names it.
inline constexpr int bits_generation = 9;

}  // namespace ballast
