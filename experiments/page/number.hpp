#pragma once
// How a page writes numbers: one way for every page.

#include "experiments/page/text.hpp"

namespace ballast::page {

/// `digits` significant digits; powers of ten below 1e-3 and from 1e6 on; a dash for NaN and
/// infinities.
Text number(double value, int digits = 3);

/// The same without trailing zeros: settings and counts, which are exact.
Text exact(double value, int digits = 7);

/// number or exact, narrow space, unit; the dash alone when the value isn't known. `unit` is in
/// the notation of marked(); empty: none.
Text quantity(double value, const char* unit, int digits = 3);
Text exact_quantity(double value, const char* unit, int digits = 7);

/// "1.23 ± 0.04": the error to two digits of its own; no error when it isn't known.
Text with_error(double value, double error);

/// A relative deviation with its sign: "+3.1 %", "−12 %".
Text percent(double relative);

/// "[1.1, 1.4]"
Text interval(double low, double high);

/// Value against its bound: "met" or "missed" with a sign that doesn't need colour; nothing when
/// either is NaN.
Text verdict(double value, double bound);

}  // namespace ballast::page
