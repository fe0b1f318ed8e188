// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/arguments.h"

#include <gtest/gtest.h>

namespace vitrine::server::cli {
namespace {

constexpr Flag kFlags[] = {{"--level", "L", ""}, {"--json", "", ""}, {"-o", "OUT", ""}};
constexpr std::string_view kOperands[] = {"IN"};
using Words = std::vector<std::string_view>;

tl::expected<Arguments, Fault> parse(const Words& words) {
  return Arguments::parse(words, kFlags, kOperands);
}

std::string fault_of(const Words& words) {
  const auto arguments = parse(words);
  if (arguments) return "";
  EXPECT_EQ(arguments.error().exit_code, 2);
  return arguments.error().message;
}

TEST(Arguments, FlagsStandBeforeAndAfterOperands) {
  for (const Words& words :
       {Words{"in", "-o", "out", "--level=3"}, Words{"--level", "3", "-o", "out", "in"}}) {
    const auto arguments = parse(words);
    ASSERT_TRUE(arguments);
    EXPECT_EQ(arguments->operand(0), "in");
    EXPECT_EQ(arguments->text("-o"), "out");
    EXPECT_EQ(arguments->number("--level", 0, 9).value(), 3u);
    EXPECT_FALSE(arguments->has("--json"));
  }
}

TEST(Arguments, AfterTwoDashesAllWordsAreOperands) {
  EXPECT_EQ(parse({"--json", "--", "--level"})->operand(0), "--level");
}

TEST(Arguments, AnOperandWithDotsMayBeRepeated) {
  constexpr std::string_view kMany[] = {"A", "B..."};
  const auto taken = [&](const Words& words) { return Arguments::parse(words, kFlags, kMany); };
  EXPECT_EQ(taken({"1", "--json", "2", "3"})->operands(),
            (std::vector<std::string>{"1", "2", "3"}));
  ASSERT_FALSE(taken({"1"}));
  EXPECT_EQ(taken({"1"}).error().message, "B... is missing");
}

TEST(Arguments, EveryFaultNamesTheWord) {
  EXPECT_EQ(fault_of({}), "IN is missing");
  EXPECT_EQ(fault_of({"a", "b"}), "unexpected word \"b\"");
  EXPECT_EQ(fault_of({"a", "--levle", "3"}), "unknown flag --levle (did you mean --level?)");
  EXPECT_EQ(fault_of({"a", "--frobnicate"}), "unknown flag --frobnicate");
  EXPECT_EQ(fault_of({"a", "--level"}), "--level needs a value: L");
  EXPECT_EQ(fault_of({"a", "--json=yes"}), "--json takes no value");
  EXPECT_EQ(fault_of({"a", "--json", "--json"}), "--json is given twice");
}

TEST(Arguments, AWrongValueIsNamedWithWhatToGive) {
  const auto arguments = parse({"in", "--level", "ten"});
  ASSERT_TRUE(arguments);
  EXPECT_EQ(arguments->number("--level", 0, 9).error().message,
            "--level cannot be \"ten\"; give a whole number from 0 to 9");
  EXPECT_EQ(arguments->distance("--level").error().message,
            "--level cannot be \"ten\"; give a number of at least 0, in the model's unit");
  constexpr std::string_view kChoices[] = {"low", "high"};
  EXPECT_EQ(arguments->choice("--level", kChoices).error().message,
            "--level cannot be \"ten\"; give one of low, high");
}

TEST(Arguments, NumbersAreCheckedToTheLastCharacter) {
  for (const char* text : {"", "x", "3x", "-1", "10", "3.0", "99999999999999999999"}) {
    EXPECT_FALSE(parse({"in", "--level", text})->number("--level", 0, 9)) << text;
  }
  for (const char* text : {"", "-1", "nan", "inf", "1e999", "0x"}) {
    EXPECT_FALSE(parse({"in", "--level", text})->distance("--level")) << text;
  }
  EXPECT_EQ(parse({"in", "--level", "2.5e-3"})->distance("--level").value(), 0.0025);
  EXPECT_FALSE(parse({"in"})->number("--level", 0, 9).value().has_value());
}

}  // namespace
}  // namespace vitrine::server::cli
