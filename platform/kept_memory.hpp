#pragma once
// What the C library does with memory that a process frees.

#include <malloc.h>

namespace ballast {

/// For processes that make the same large arrays again and again: from here on this one keeps the
/// memory that it frees, up to 64 MB, as the C library does by itself once a block of 32 MB was
/// freed. Before that blocks of megabytes are given back to the system at once, and the next ones
/// come page by page, a quarter of a microsecond each: as much time as filling them.
inline void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
}

/// From here on, until keep_freed_memory(), every block of 128 kB or more goes back to the system
/// as soon as it is freed: for the time in which arrays grow to their size, each time by a copy.
inline void return_large_blocks() { mallopt(M_MMAP_THRESHOLD, 128 << 10); }

/// After much has been made and freed: gives the pages that nothing stands on back to the system,
/// also those between what stays.
inline void give_memory_back() { malloc_trim(0); }

}  // namespace ballast
