// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/sheet.h"

#include <gmock/gmock.h>

#include <random>

namespace vitrine::test {
namespace {

using server::cli::kMaxSheetBytes;
using server::cli::read_sheet;
using server::cli::SheetRow;
using testing::HasSubstr;

constexpr std::string_view kColumns[] = {"file", "title", "creator", "licence"};

Expected<std::vector<SheetRow>> read(std::string_view csv) {
  return read_sheet(csv, "sheet.csv", kColumns);
}

void expect_fault(std::string_view csv, ErrorCode code, const std::string& text) {
  const auto rows = read(csv);
  ASSERT_FALSE(rows) << csv;
  EXPECT_EQ(rows.error().code, code) << csv;
  EXPECT_THAT(rows.error().message, HasSubstr(text));
}

TEST(Sheet, QuotedCellsHoldSeparatorsQuotationMarksAndLines) {
  const auto rows = read(
                        "file,title,creator\r\n"
                        "a.ply,\"Bust, \"\"young\"\" girl\",\"one\r\ntwo\"\r\n"
                        "b.ply,\"\"\"\",\n")
                        .value();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].line, 2u);
  EXPECT_EQ(rows[0].text("file"), "a.ply");
  EXPECT_EQ(rows[0].text("title"), "Bust, \"young\" girl");
  EXPECT_EQ(rows[0].text("creator"), "one\ntwo");
  EXPECT_EQ(rows[1].line, 4u);
  EXPECT_EQ(rows[1].text("title"), "\"");
  EXPECT_EQ(rows[1].text("creator"), "");
}

TEST(Sheet, SeparatorByteOrderMarkAndCaseAreThoseOfAnySpreadsheet) {
  for (const std::string separator : {",", ";", "\t"}) {
    const auto rows =
        read(
            "\xef\xbb\xbf"
            "File" +
            separator + " TITLE\na.ply" + separator + "\"B\xc3\xbcste, klein; alt\"\nlast.ply")
            .value();
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].text("title"), "B\xc3\xbcste, klein; alt");
    EXPECT_EQ(rows[1].text("file"), "last.ply");
  }
}

TEST(Sheet, BlanksMayPrecedeAQuotationMarkAndLinesMayEndInReturns) {
  const auto rows = read("file, title\ra.ply, \"Bust, small\" \rb.ply,\t B\r").value();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].text("title"), "Bust, small");
  EXPECT_EQ(rows[1].text("title"), "B");
  EXPECT_EQ(rows[1].line, 3u);
}

TEST(Sheet, EmptyLinesAndUnnamedEmptyColumnsAreLeftOut) {
  const auto rows = read("file,title,,\n,,,\n\na.ply,A,,\n").value();
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].line, 4u);
}

TEST(Sheet, FaultsNameLineAndNextStep) {
  const auto bad = ErrorCode::kBadInput;
  expect_fault("", bad, "sheet.csv, line 1: no column is named file; name the columns");
  expect_fault("title\nA\n", bad, "no column is named file");
  expect_fault("file,license\n", bad, "no text is named \"license\"; did you mean licence?");
  expect_fault("file,Weight in kg\n", bad, "leave that column out");
  expect_fault("file,title,title\n", bad, "two columns are named title");
  expect_fault("file,title\n,A\n", bad, "line 2: file is missing");
  expect_fault("file,title\na,A\n\na,B\n", bad, "line 4: file a has two rows");
  expect_fault("file,title\na,A,B\n", bad, "line 2: cell 3 has a text, but its column has no name");
  expect_fault("file,title\na,\"A\nb,B\n", bad, "line 2: a quotation mark is not closed");
  expect_fault("file,title\na,B\xfcste\n", bad, "sheet.csv is not UTF-8; save it as CSV UTF-8");
  expect_fault(std::string(kMaxSheetBytes + 1, ' '), ErrorCode::kLimit, "larger than 64 MiB");
  std::string many = "file\n";
  for (std::size_t i = 0; i <= server::cli::kMaxSheetRows; ++i)
    many += std::to_string(i) + "\n";
  expect_fault(many, ErrorCode::kLimit, "more than 100000 rows");
}

// Reads random tables of CSV. If the reader accepts a table, each of its rows must name a file.
TEST(Sheet, RandomBytesGiveRowsOrAnError) {
  std::mt19937 random(7);
  constexpr std::string_view kBytes = "file,title;\t\"\"\"\r\n\n ab";
  for (int i = 0; i < 20'000; ++i) {
    std::string csv = "file,title\n";
    for (auto length = random() % 40; length > 0; --length)
      csv += kBytes[random() % kBytes.size()];
    const auto rows = read(csv);
    if (!rows) continue;
    for (const SheetRow& row : *rows)
      ASSERT_NE(row.text("file"), "") << csv;
  }
}

}  // namespace
}  // namespace vitrine::test
