// Vector code for the processor that a program runs on, in libraries compiled for any x86-64.
#pragma once

// Without optimisation nothing would be inlined, under sanitizers every version would be watched; and a build for AVX2
// has it everywhere. Where there are versions, only those for wide registers are worth the time of inlining all.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DOVETAIL_HAS_WIDE_CODE 0
#define DOVETAIL_FLATTEN
#elif defined(__x86_64__) && defined(__OPTIMIZE__) && !defined(__AVX2__)
#define DOVETAIL_HAS_WIDE_CODE 1
#define DOVETAIL_FLATTEN
#else
#define DOVETAIL_HAS_WIDE_CODE 0
#define DOVETAIL_FLATTEN [[gnu::flatten]]
#endif

namespace dovetail {

/// Versions of the code, each for processors that have more than the one before.
enum class VectorCode { portable, avx2, avx512 };

/// The version to be taken: at first, the last one that the processor can run.
VectorCode& vectorCode();

#if DOVETAIL_HAS_WIDE_CODE
/// Compiles all of `body` that can be inlined for AVX2. Without FMA, so that the digits are those of the portable code.
/// What is not inlined must not take or return vector_size types by value: the registers would differ.
template <class Body>
[[gnu::target("avx2"), gnu::flatten, gnu::noinline]] void runAvx2(const Body& body) {
  body();
}

/// The same with the 32 registers of AVX-512.
template <class Body>
[[gnu::target("avx512f,avx512vl,avx512dq,avx512bw"), gnu::flatten, gnu::noinline]] void runAvx512(const Body& body) {
  body();
}
#endif

/// Calls body(), compiled once per version, in the version that fits the processor.
template <class Body>
DOVETAIL_FLATTEN void withVectors(const Body& body) {
#if DOVETAIL_HAS_WIDE_CODE
  if (vectorCode() == VectorCode::avx512) return runAvx512(body);
  if (vectorCode() == VectorCode::avx2) return runAvx2(body);
#endif
  body();
}

}  // namespace dovetail
