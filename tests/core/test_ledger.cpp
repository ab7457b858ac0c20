#include <gtest/gtest.h>

#include <sstream>

#include "dovetail/core/error.hpp"
#include "dovetail/core/ledger.hpp"

namespace dovetail {
namespace {

TEST(EnergyLedger, ResidualIsZeroWhenEveryJouleIsBooked) {
  EnergyLedger ledger;
  const auto kinetic = ledger.addStored("kinetic");
  const auto dashpot = ledger.addBooked("dashpot");
  ledger.set(kinetic, 5.0);
  ledger.open();
  ledger.set(kinetic, 3.5);
  ledger.add(dashpot, 1.5);
  ledger.close();
  EXPECT_DOUBLE_EQ(ledger.residual(), 0.0);
  EXPECT_DOUBLE_EQ(ledger.largestDrift(), 1.5);
}

TEST(EnergyLedger, UnbookedLossShowsInTheResidualWithItsSign) {
  EnergyLedger ledger;
  const auto kinetic = ledger.addStored("kinetic");
  ledger.set(kinetic, 5.0);
  ledger.open();
  ledger.set(kinetic, 4.0);
  ledger.close();
  ledger.set(kinetic, 5.0);
  ledger.close();
  EXPECT_DOUBLE_EQ(ledger.residual(), 0.0);
  EXPECT_DOUBLE_EQ(ledger.largestResidual(), 1.0);
  EXPECT_DOUBLE_EQ(ledger.storedMin(), 4.0);
  EXPECT_DOUBLE_EQ(ledger.storedMax(), 5.0);
}

TEST(EnergyLedger, PrintsEveryChannelAndTheResidual) {
  EnergyLedger ledger;
  ledger.addStored("kinetic, particles");
  ledger.addBooked("dashpot");
  std::ostringstream text;
  text << ledger;
  EXPECT_NE(text.str().find("kinetic, particles"), std::string::npos);
  EXPECT_NE(text.str().find("dashpot [booked]"), std::string::npos);
  EXPECT_NE(text.str().find("residual"), std::string::npos);
}

TEST(EnergyLedger, ChannelsByNameAppearWithTheirFirstJouleAndComeBackFromBytes) {
  using Kind = EnergyLedger::Kind;
  EnergyLedger ledger;
  ledger.set("same name", Kind::stored, 0.0);
  ledger.set("nothing", Kind::booked, 0.0);
  ledger.open();
  for (const double joules : {0.0, 2.0, 0.5}) ledger.add("same name", joules);
  ledger.set("same name", Kind::stored, -2.0);
  ASSERT_EQ(ledger.channels().size(), 2u);
  ByteWriter bytes;
  ledger.save(bytes);
  EnergyLedger again;
  ByteReader archive(bytes.bytes());
  again.load(archive);
  EXPECT_TRUE(archive.atEnd());
  for (const EnergyLedger* one : {&ledger, &again}) {
    EXPECT_EQ(one->find("same name", Kind::booked)->joules, 2.5);
    EXPECT_EQ(one->residual(), 0.5);
  }
  std::vector<char> cut = bytes.bytes();
  cut.pop_back();
  ByteReader damaged(cut);
  EXPECT_THROW(again.load(damaged), InputError);
  EXPECT_EQ(again.channels().size(), 2u);
}

}  // namespace
}  // namespace dovetail
