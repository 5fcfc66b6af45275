// Numbers in text are read whole or not at all; numbers in messages can be told apart.
#include "base/number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gaussdrift::base {
namespace {

TEST(ReadNumber, IsReadWithSignExponentAndBlanksAround) {
  EXPECT_EQ(read_number<double>("0"), 0);
  EXPECT_EQ(read_number<double>("+1"), 1);
  EXPECT_EQ(read_number<double>("-2.5e-3"), -2.5e-3);
  EXPECT_EQ(read_number<double>(" 1.5\r\n"), 1.5);
  EXPECT_EQ(read_number<double>(".5"), 0.5);
  EXPECT_EQ(read_number<double>("5."), 5);
  EXPECT_EQ(read_number<int>("+7"), 7);
  EXPECT_EQ(read_number<int>("-7"), -7);
  EXPECT_TRUE(std::isnan(*read_number<double>("nan")));
  EXPECT_EQ(read_number<double>("-inf"), -std::numeric_limits<double>::infinity());
}

TEST(ReadNumber, IsNotTheBeginningOfAText) {
  for (const char* text :
       {"", " ", "0,5", "1,5", "1.5.2", "1 2", "1.5m", "1e", "1d-3", "0x10", "+", "-", "+-1", "++1", "--1", "one"})
    EXPECT_EQ(read_number<double>(text), std::nullopt) << text;
  for (const char* text : {"1.5", "1e3", "2147483648", "99999999999", "", "7,"})
    EXPECT_EQ(read_number<int>(text), std::nullopt) << text;
  EXPECT_EQ(read_number<std::size_t>("-1"), std::nullopt);
  EXPECT_EQ(read_number<double>("1e999"), std::nullopt);
}

TEST(ToldApart, ShowsSixDigitsOrTheDifference) {
  EXPECT_EQ(told_apart(1.0 / 3), "0.333333");
  EXPECT_EQ(told_apart(0.7, 0.0, 0.699999988079071), "0.7");
  EXPECT_EQ(told_apart(0.699999988079071, 0.7), "0.69999999");
  EXPECT_EQ(told_apart(1.0000000000000002, 1.0), "1.0000000000000002");
  EXPECT_EQ(told_apart(2.0, 2.0), "2");  // the same number needs no more digits
}

}  // namespace
}  // namespace gaussdrift::base
