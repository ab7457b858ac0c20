// All versions of the code for the processor's registers (dovetail/core/vector_code.hpp) give the same digits.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "dovetail/core/vector_code.hpp"

namespace dovetail::test {

/// Compares what a function of no arguments gives with every version that the processor can run.
/// @param numbers  gives a std::vector<double>
template <class Function>
void expectSameDigitsOfEveryVectorCode(const std::string& what, Function&& numbers) {
  using enum VectorCode;
  const VectorCode best = vectorCode();
  if (best == portable) GTEST_SKIP() << "the processor has no wide registers";
  vectorCode() = portable;
  const std::vector<double> expected = numbers();
  for (const VectorCode code : {avx2, avx512}) {
    if (code > best) break;
    vectorCode() = code;
    const std::vector<double> wide = numbers();
    vectorCode() = best;
    ASSERT_EQ(wide.size(), expected.size());
    for (std::size_t i = 0; i < wide.size(); ++i)
      ASSERT_EQ(wide[i], expected[i]) << what << ", number " << i << ", version " << static_cast<int>(code);
  }
}

}  // namespace dovetail::test
