#include "tests/geometry/contact/allocation_counter.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

// These operators have a file of their own, so that no call is inlined and the compiler sees new
// and delete, not malloc and free.
namespace {
std::atomic<long> allocations{0};
}

// AddressSanitizer has operators of its own, which it checks against each other: nothing is counted
// under it.
#if !defined(__SANITIZE_ADDRESS__)
void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif

long ballast::testing::allocation_count() { return allocations; }
