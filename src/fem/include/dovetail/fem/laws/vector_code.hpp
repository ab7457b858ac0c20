// Vector code for the processor that a program runs on, in libraries compiled for any x86-64.
#pragma once

// Without optimisation nothing would be inlined; and a build for AVX2 has it everywhere.
#if defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__AVX2__)
#define DOVETAIL_HAS_WIDE_CODE 1
#else
#define DOVETAIL_HAS_WIDE_CODE 0
#endif

namespace dovetail::fem::detail {

/// Whether the code for AVX2 is to be taken: at first, whether the processor has it.
bool& wideVectors();

#if DOVETAIL_HAS_WIDE_CODE
/// Compiles all of `body` that can be inlined for AVX2. Without FMA, so that the digits are those of the portable code.
/// What is not inlined must not take or return vector_size types by value: the registers would differ.
template <class Body>
[[gnu::target("avx2"), gnu::flatten, gnu::noinline]] void runWide(const Body& body) {
  body();
}
#endif

/// Calls body(), compiled twice, in the version that fits the processor.
template <class Body>
[[gnu::flatten]] void withVectors(const Body& body) {
#if DOVETAIL_HAS_WIDE_CODE
  if (wideVectors()) return runWide(body);
#endif
  body();
}

}  // namespace dovetail::fem::detail
