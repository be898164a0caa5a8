#pragma once

namespace ballast::testing {

/// The number of calls of operator new in this executable so far. Linking allocation_counter.cpp
/// replaces the operator, except under AddressSanitizer, where the count stays 0.
long allocation_count();

}  // namespace ballast::testing
