#pragma once
// For processes that make the same large arrays again and again.

#include <malloc.h>

namespace ballast {

/// From here on this process keeps the memory that it frees. Blocks of megabytes are otherwise
/// given back to the system at once, and the next ones come page by page, a quarter of a
/// microsecond each: as much time as filling them. (Blocks above 32 MB go back all the same.)
inline void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace ballast
