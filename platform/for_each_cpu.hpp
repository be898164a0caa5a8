#pragma once
// BALLAST_FOR_EACH_CPU marks a function that is compiled for several instruction sets; the best
// version for the processor is chosen when the program starts. It is empty where the compiler or a
// sanitizer does not support this. BALLAST_IN_LOOP marks a function that its loops call: it is
// inlined into each version and compiled for that instruction set.

#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define BALLAST_FOR_EACH_CPU __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define BALLAST_FOR_EACH_CPU
#endif
#define BALLAST_IN_LOOP [[gnu::always_inline]] inline
