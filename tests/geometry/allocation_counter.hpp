#pragma once

namespace ballast::testing {

/// Calls of operator new in this executable so far. Linking allocation_counter.cpp replaces the operator.
long allocation_count();

}  // namespace ballast::testing
