// SPDX-License-Identifier: Apache-2.0
// Tests that a catalogue keeps the notes and tours of models.
#include <gtest/gtest.h>

#include "conformance/catalogue_suite.h"
#include "conformance/id_of.h"

namespace vitrine::test {
namespace {

class NotesSuite : public testing::Test {
 protected:
  NotesSuite() {
    EXPECT_TRUE(catalogue_->add({.id = id_of(1), .state = ModelState::kPublished}, {}));
    EXPECT_TRUE(catalogue_->add({.id = id_of(2)}, {}));
  }
  Expected<void> put(std::uint8_t model, NoteKind kind, const NoteSheet& sheet) {
    return notes_->put(id_of(model), kind, sheet);
  }
  NoteSheet sheet(std::uint8_t model, NoteKind kind = NoteKind::kNotes) {
    return backend_->connect_notes()->find(id_of(model), kind).value();
  }

  const std::unique_ptr<CatalogueBackend> backend_ = make_catalogue_backend();
  const std::unique_ptr<Catalogue> catalogue_ = backend_->connect();
  const std::unique_ptr<NoteCatalogue> notes_ = backend_->connect_notes();
};

TEST_F(NotesSuite, AModelHasNoneAtFirst) {
  EXPECT_EQ(sheet(1).version, 0u);
  EXPECT_EQ(sheet(1).text, "");
  EXPECT_EQ(catalogue_->find(id_of(1)).value()->notes, 0u);
}

TEST_F(NotesSuite, NotesAndToursAreKeptApart) {
  ASSERT_TRUE(put(1, NoteKind::kNotes, {.entries = 2, .text = R"(["é"])"}));
  ASSERT_TRUE(put(1, NoteKind::kTours, {.entries = 1, .text = "[]"}));
  EXPECT_EQ(sheet(1).text, R"(["é"])");
  EXPECT_EQ(sheet(1).entries, 2u);
  EXPECT_EQ(sheet(1, NoteKind::kTours).text, "[]");
  EXPECT_EQ(sheet(2).version, 0u);
}

TEST_F(NotesSuite, AModelStatesTheNumberOfItsNotesWhereverItIsRead) {
  ASSERT_TRUE(put(1, NoteKind::kNotes, {.entries = 6, .text = "[]"}));
  ASSERT_TRUE(put(1, NoteKind::kTours, {.entries = 1, .text = "[]"}));
  EXPECT_EQ(catalogue_->find(id_of(1)).value()->notes, 6u);
  EXPECT_EQ(catalogue_->search({}).value().models.at(0).notes, 6u);
  const Harvest harvest = catalogue_->harvest({}).value();
  EXPECT_EQ(harvest.models.at(0).model.notes, 6u);
  EXPECT_GT(harvest.models.at(0).changed, 0);
}

TEST_F(NotesSuite, AChangeOfTheModelKeepsItsNotes) {
  ASSERT_TRUE(put(1, NoteKind::kNotes, {.entries = 6, .text = "[1]"}));
  ModelRecord model = catalogue_->find(id_of(1)).value().value();
  model.title = "Bust";
  model.notes = 0;
  ASSERT_TRUE(catalogue_->update(model, std::nullopt));
  EXPECT_EQ(catalogue_->find(id_of(1)).value()->notes, 6u);
  EXPECT_EQ(sheet(1).text, "[1]");
}

TEST_F(NotesSuite, OfTwoChangesOfTheSameVersionOneIsRefused) {
  for (int round = 0; round < 2; ++round) {
    const NoteSheet read = sheet(1);
    ASSERT_TRUE(put(1, NoteKind::kNotes, {read.version, 1, "[1]"}));
    const auto late = put(1, NoteKind::kNotes, {read.version, 1, "[2]"});
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, ErrorCode::kState);
    EXPECT_EQ(sheet(1).text, "[1]");
    EXPECT_EQ(sheet(1).version, read.version + 1);
  }
}

TEST_F(NotesSuite, AModelThatDoesNotExistHasNoNotes) {
  const auto put_there = put(9, NoteKind::kNotes, {.entries = 1, .text = "[1]"});
  ASSERT_FALSE(put_there);
  EXPECT_EQ(put_there.error().code, ErrorCode::kState);
}

TEST_F(NotesSuite, ARemovedModelTakesItsNotesWithIt) {
  ASSERT_TRUE(put(1, NoteKind::kNotes, {.entries = 1, .text = "[1]"}));
  ASSERT_TRUE(catalogue_->remove(id_of(1), {}));
  ASSERT_TRUE(catalogue_->add({.id = id_of(1)}, {}));
  EXPECT_EQ(sheet(1).text, "");
}

TEST_F(NotesSuite, AChangeIsSeenByOtherDaemons) {
  for (const std::uint64_t version : {0u, 1u}) {
    const auto before = catalogue_->revision().value();
    ASSERT_TRUE(put(1, NoteKind::kNotes, {version, 1, "[1]"}));
    EXPECT_NE(catalogue_->revision().value(), before);
  }
}

}  // namespace
}  // namespace vitrine::test
