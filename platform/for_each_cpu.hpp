#pragma once
// BALLAST_FOR_EACH_CPU stands before a function that is compiled for several instruction sets; the
// best one that the processor has is chosen when the program starts. Empty where the compiler or a
// sanitizer cannot do so. BALLAST_IN_LOOP stands before one that its loops call: it becomes a part
// of each version, where it is compiled as that.

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define BALLAST_FOR_EACH_CPU __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define BALLAST_FOR_EACH_CPU
#endif
#define BALLAST_IN_LOOP [[gnu::always_inline]] inline
