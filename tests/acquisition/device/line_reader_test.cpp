// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/line_reader.h"

#include <gtest/gtest.h>

namespace vitrine::acquisition {
namespace {

TEST(LineReader, CutsWhateverWayTheBytesArrive) {
  const std::string bytes = "ok\r\n\r\n<Idle>\r\nerr";
  LineReader reader;
  for (const char byte : bytes)
    reader.feed({&byte, 1});
  EXPECT_EQ(reader.next(), "ok");
  EXPECT_EQ(reader.next(), "<Idle>");
  EXPECT_EQ(reader.next(), std::nullopt) << "not ended yet";
  reader.feed("or\n");
  EXPECT_EQ(reader.next(), "error");
}

TEST(LineReader, TakesAPromptForALineAtTheStartOfOneOnly) {
  LineReader reader('>');
  reader.feed("a>b\n>M17\n>");
  EXPECT_EQ(reader.next(), "a>b");
  EXPECT_EQ(reader.next(), ">");
  EXPECT_EQ(reader.next(), "M17");
  EXPECT_EQ(reader.next(), ">");
  EXPECT_EQ(reader.next(), std::nullopt);
}

TEST(LineReader, HandsOutWhatIsNoLineAsGarbage) {
  LineReader reader;
  reader.feed("o\x80k\n" + std::string(LineReader::kLongest + 1, 'x') + "\nok\n");
  EXPECT_EQ(reader.next(), LineReader::kGarbage);
  EXPECT_EQ(reader.next(), LineReader::kGarbage);
  EXPECT_EQ(reader.next(), "ok");
}

TEST(LineReader, KeepsTheLatestOfTooManyLines) {
  LineReader reader;
  for (std::size_t i = 0; i < LineReader::kMostLines + 5; ++i)
    reader.feed(std::to_string(i) + '\n');
  EXPECT_EQ(reader.next(), "5");
}

}  // namespace
}  // namespace vitrine::acquisition
