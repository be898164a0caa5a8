#pragma once
// What the C library does with memory that a process frees.

#include <link.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <span>

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
/// also those between what stays. Of the program and its libraries it gives back what nobody has
/// written on, half of which only their start needed: the system finds it again in their files.
inline void give_memory_back() {
  malloc_trim(0);
  dl_iterate_phdr(
      [](dl_phdr_info* object, size_t, void*) {
        const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
        for (const auto& part : std::span(object->dlpi_phdr, object->dlpi_phnum)) {
          if (part.p_type != PT_LOAD || (part.p_flags & PF_W)) continue;
          const std::uintptr_t begin = object->dlpi_addr + part.p_vaddr,
                               first = begin / page * page;
          madvise(reinterpret_cast<void*>(first), begin + part.p_memsz - first, MADV_DONTNEED);
        }
        return 0;
      },
      nullptr);
}

}  // namespace ballast
