#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "dovetail/core/atomic_file.hpp"
#include "dovetail/core/error.hpp"
#include "dovetail/core/lost_error.hpp"
#include "dovetail/core/team.hpp"

namespace dovetail {
namespace {

template <class Thrown, class Kind>
void expectPassedOn(const Thrown& thrown) {
  try {
    throw thrown;
  } catch (...) {
    const auto [failure, text] = failureNow();
    try {
      raise(failure, text, "rank 3");
    } catch (const Kind& error) {
      EXPECT_EQ(error.what(), text + " [rank 3]");
      return;
    } catch (...) {
    }
  }
  ADD_FAILURE() << "another kind came out";
}

TEST(Failure, IsThrownElsewhereAsWhatItIs) {
  expectPassedOn<InputError, InputError>({"a", "b", "c"});
  expectPassedOn<NumericalError, NumericalError>({"a", "b", "c"});
  expectPassedOn<LostError, LostError>({"a", "b", "c"});
  expectPassedOn<std::bad_alloc, LostError>({});
  expectPassedOn<std::runtime_error, Error>(std::runtime_error("a"));
}

TEST(Team, OfOneIsItsOnlyRank) {
  EXPECT_EQ(team().rank(), 0);
  EXPECT_EQ(team().size(), 1);
  EXPECT_TRUE(writesFiles());
  EXPECT_EQ(team().sum(2.5), 2.5);
  EXPECT_EQ(team().largest(-2.5), -2.5);
  EXPECT_EQ(team().gather({'a'}), std::vector<std::vector<char>>{{'a'}});
  EXPECT_EQ(team().exchange({{'b'}}), std::vector<std::vector<char>>{{'b'}});
  EXPECT_THROW(together([] { throw InputError("a", "b", "c"); }), InputError);
}

}  // namespace
}  // namespace dovetail
