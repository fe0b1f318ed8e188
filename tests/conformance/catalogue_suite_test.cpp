// SPDX-License-Identifier: Apache-2.0
#include "conformance/catalogue_suite.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>
#include <tuple>

#include "conformance/id_of.h"

namespace vitrine::test {
namespace {

Sha256 digest(std::uint8_t value) {
  Sha256 sha256{};
  sha256.fill(value);
  return sha256;
}

ModelRecord model(std::uint8_t value, const std::string& title = "A skull",
                  ModelState state = ModelState::kPublished) {
  return {.id = id_of(value),
          .state = state,
          .created = 1'700'000'000'000 + value,
          .title = title,
          .creator = "Anna Müller",
          .rights = "free",
          .licence = "CC0-1.0",
          .unit = "mm",
          .file = digest(value),
          .file_bytes = 1'000,
          .head_bytes = 100,
          .faces = 20,
          .vertices = 12,
          .textures = {.count = 2, .largest_side = 2'048, .bytes = 700},
          .repairs = "1 face dropped; check it\n1 file 'Büste.png' missing",
          .presentation = {.rotation = {0.6, 0, 0, 0.8},
                           .scale = 25.4,
                           .view = PresentedView{.azimuth = 30, .target = Vec3{1, 2, 0.1}},
                           .turned_box = Bounds{{0, 0, 0}, {1, 2, 3}}}};
}

class CatalogueSuite : public testing::Test {
 protected:
  std::unique_ptr<CatalogueBackend> backend_ = make_catalogue_backend();
  std::unique_ptr<server::Catalogue> catalogue_ = backend_->connect();

  void add(const ModelRecord& record, std::vector<server::ChunkPlace> chunks = {}) {
    const auto added = catalogue_->add(record, chunks);
    ASSERT_TRUE(added) << added.error().message;
  }
  std::vector<server::ModelId> search(const ModelQuery& query) {
    std::vector<ModelId> ids;
    const ModelPage page = catalogue_->search(query).value();
    for (const auto& found : page.models)
      ids.push_back(found.id);
    return ids;
  }
};

TEST_F(CatalogueSuite, AModelIsFoundAsItWasAdded) {
  const ModelRecord added = model(1, "L'Écorché \"no. 3\"; DROP TABLE model");
  add(added);
  const auto found = catalogue_->find(added.id).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->state, added.state);
  EXPECT_EQ(found->created, added.created);
  EXPECT_EQ(found->title, added.title);
  EXPECT_EQ(found->creator, added.creator);
  EXPECT_EQ(found->rights, added.rights);
  EXPECT_EQ(found->licence, added.licence);
  EXPECT_EQ(found->unit, added.unit);
  EXPECT_EQ(found->file, added.file);
  EXPECT_EQ(found->file_bytes, added.file_bytes);
  EXPECT_EQ(found->head_bytes, added.head_bytes);
  EXPECT_EQ(found->faces, added.faces);
  EXPECT_EQ(found->vertices, added.vertices);
  EXPECT_EQ(found->textures, added.textures);
  EXPECT_EQ(found->repairs, added.repairs);
  EXPECT_EQ(found->presentation, added.presentation);
}

TEST_F(CatalogueSuite, TheNewestPublishedModelOfAFileAndItsTextsIsFound) {
  server::ModelRecord other = model(1);
  EXPECT_FALSE(catalogue_->find_same(other).value());
  add(other);
  other.id = id_of(2);
  EXPECT_EQ(catalogue_->find_same(other).value().value().id, id_of(1));
  add(other);
  EXPECT_EQ(catalogue_->find_same(other).value().value().id, id_of(2));
  ASSERT_TRUE(catalogue_->set_state(id_of(2), server::ModelState::kDraft));
  EXPECT_EQ(catalogue_->find_same(other).value().value().id, id_of(1));
  for (std::string ModelRecord::*text :
       {&ModelRecord::title, &ModelRecord::creator, &ModelRecord::rights, &ModelRecord::licence}) {
    ModelRecord changed = other;
    changed.*text += ".";
    EXPECT_FALSE(catalogue_->find_same(changed).value());
  }
  other.file = digest(9);
  EXPECT_FALSE(catalogue_->find_same(other).value());
}

TEST_F(CatalogueSuite, AnAbsentModelIsNotAnError) {
  const auto found = catalogue_->find(id_of(1));
  ASSERT_TRUE(found);
  EXPECT_FALSE(*found);
}

TEST_F(CatalogueSuite, AnIdIsTakenOnceAndTheRefusedModelLeavesNoChunk) {
  add(model(1));
  const std::vector<server::ChunkPlace> chunks{{digest(9), 0, 10}};
  const auto again = catalogue_->add(model(1, "another"), chunks);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::kState);
  EXPECT_EQ(catalogue_->find(id_of(1)).value()->title, "A skull");
  EXPECT_FALSE(catalogue_->find_chunk(digest(9)).value());
}

TEST_F(CatalogueSuite, ASearchListsTheNewestFirstAndNoDrafts) {
  add(model(1));
  add(model(3));
  add(model(2, "hidden", ModelState::kDraft));
  EXPECT_EQ(search({}), (std::vector<ModelId>{id_of(3), id_of(1)}));
  EXPECT_EQ(search({.includes_drafts = true}),
            (std::vector<ModelId>{id_of(3), id_of(2), id_of(1)}));
}

TEST_F(CatalogueSuite, EveryWordMustBeginAWordOfTheTexts) {
  add(model(1, "Head of Demosthenes"));
  add(model(2, "Head of a girl"));
  EXPECT_EQ(search({.text = "head demos"}), std::vector<ModelId>{id_of(1)});
  EXPECT_EQ(search({.text = " anna  GIRL "}), std::vector<ModelId>{id_of(2)});
  EXPECT_EQ(search({.text = "hand"}), std::vector<server::ModelId>{});
}

// Returns a record of a model with the further metadata `more`.
ModelRecord described(std::uint8_t value, std::map<std::string, std::string> more,
                      ModelState state = ModelState::kPublished) {
  ModelRecord record = model(value, "A skull", state);
  record.more = std::move(more);
  return record;
}

TEST_F(CatalogueSuite, ASearchFindsWordsOfAllTextsWithoutCaseAndAccents) {
  add(described(1, {{"description", "L'Écorché,\nof \"plaster\"; no. 1898.12"}}));
  add(described(2, {{"material", "Bronze"}, {"provenance", "Πειραιάς"}}));
  for (const char* words : {"ecorche", "ÉCORCHÉ plaster", "1898.12", "12 1898", "cc0 plaster"})
    EXPECT_EQ(search({.text = words}), std::vector<ModelId>{id_of(1)}) << words;
  for (const char* words : {"bronze", "BRON mull", "Πειραιάς"})
    EXPECT_EQ(search({.text = words}), std::vector<ModelId>{id_of(2)}) << words;
  EXPECT_EQ(search({.text = "description"}), std::vector<ModelId>{}) << "names are no texts";
}

TEST_F(CatalogueSuite, PunctuationInASearchOnlySeparatesWords) {
  add(model(1, "100 % marble"));
  for (const char* words : {"%", "_", "\\", "'", "\"", "100*", "marble & 100", "!marble", "(100",
                            ":*", "NOT", "\"a", "--", "“marble”", "a OR b"})
    EXPECT_TRUE(catalogue_->search({.text = words})) << words;
  EXPECT_EQ(search({.text = "100*|"}), std::vector<ModelId>{id_of(1)});
  EXPECT_EQ(search({.text = "wood OR marble"}), std::vector<ModelId>{}) << "words, not operators";
}

TEST_F(CatalogueSuite, ASearchKnowsEachChange) {
  ModelRecord changed = model(1, "Bust");
  add(changed);
  changed.title = "Torso";
  changed.more = {{"material", "bronze; gold"}};
  ASSERT_TRUE(catalogue_->update(changed, std::nullopt));
  EXPECT_TRUE(search({.text = "bust"}).empty());
  EXPECT_EQ(search({.text = "torso gold"}), std::vector<ModelId>{id_of(1)});
  EXPECT_EQ(search({.facets = {{"material", "gold"}}}), std::vector<ModelId>{id_of(1)});
  ASSERT_TRUE(catalogue_->set_state(id_of(1), ModelState::kDraft));
  EXPECT_TRUE(search({.text = "torso"}).empty());
  EXPECT_TRUE(search({.facets = {{"material", "gold"}}}).empty());
  EXPECT_EQ(catalogue_->facets({}).value().counts.size(), 0u);
  ASSERT_TRUE(catalogue_->remove(id_of(1), std::nullopt));
  EXPECT_TRUE(search({.text = "torso", .includes_drafts = true}).empty());
  add(model(1, "Bust"));
  EXPECT_EQ(search({.text = "bust"}), std::vector<ModelId>{id_of(1)});
}

TEST_F(CatalogueSuite, FacetsNarrowASearchAndAreCounted) {
  add(described(1, {{"material", "bronze; gold"}, {"period", "Hellenistic"}}));
  add(described(2, {{"material", "bronze;;bronze "}, {"subject", "\"rings\"; \\"}}));
  add(described(3, {{"material", "bronze"}}, ModelState::kDraft));
  using Count = server::FacetCount;
  const auto all = catalogue_->facets({}).value();
  EXPECT_EQ(all.models, 2u);
  EXPECT_EQ(all.counts, (std::vector<Count>{{"creator", "Anna Müller", 2},
                                            {"licence", "CC0-1.0", 2},
                                            {"material", "bronze", 2},
                                            {"material", "gold", 1},
                                            {"period", "Hellenistic", 1},
                                            {"subject", "\"rings\"", 1},
                                            {"subject", "\\", 1}}));
  const ModelQuery narrow{.text = "anna",
                          .facets = {{"material", "bronze"}, {"period", "Hellenistic"}}};
  EXPECT_EQ(search(narrow), std::vector<ModelId>{id_of(1)});
  EXPECT_EQ(catalogue_->facets(narrow).value().models, 1u);
  EXPECT_EQ(catalogue_->facets({.facets = {{"material", "bronze"}}, .includes_drafts = true})
                .value()
                .models,
            3u);
  EXPECT_TRUE(search({.facets = {{"material", "Bronze"}}}).empty());
}

TEST_F(CatalogueSuite, AFacetCountsItsMostFrequentValues) {
  for (std::uint8_t i = 0; i < 40; ++i)
    add(described(i, {{"subject", "subject " + std::to_string(i) + (i % 2 == 0 ? "; even" : "")}}));
  std::vector<server::FacetCount> subjects = catalogue_->facets({}).value().counts;
  std::erase_if(subjects, [](const auto& count) { return count.name != "subject"; });
  ASSERT_EQ(subjects.size(), server::kMostFacetValues);
  EXPECT_EQ(subjects.front(), (server::FacetCount{"subject", "even", 20}));
}

TEST_F(CatalogueSuite, EachOrderHasPagesWithoutGapOrRepetition) {
  const char* const titles[] = {"beta", "Alpha", "", "alpha", "Gamma"};
  for (std::uint8_t i = 0; i < 5; ++i)
    add(model(i, titles[i]));
  using enum server::ModelOrdering;
  const auto in_order = [&](server::ModelOrdering ordering) {
    std::vector<ModelId> ids;
    ModelQuery query{.ordering = ordering, .limit = 2};
    do {
      const ModelPage page = catalogue_->search(query).value();
      for (const auto& found : page.models)
        ids.push_back(found.id);
      query.after = page.next;
    } while (query.after);
    return ids;
  };
  const auto ids = [](std::initializer_list<std::uint8_t> values) {
    std::vector<ModelId> all;
    for (const std::uint8_t value : values)
      all.push_back(id_of(value));
    return all;
  };
  EXPECT_EQ(in_order(kNewest), ids({4, 3, 2, 1, 0}));
  EXPECT_EQ(in_order(kOldest), ids({0, 1, 2, 3, 4}));
  EXPECT_EQ(in_order(kTitle), ids({2, 1, 3, 0, 4}));
  EXPECT_EQ(in_order(kCreator), ids({0, 1, 2, 3, 4}));
}

TEST_F(CatalogueSuite, PagesFollowEachOtherWithoutGapOrRepetition) {
  for (std::uint8_t i = 1; i <= 7; ++i)
    add(model(i));
  std::vector<server::ModelId> seen;
  server::ModelQuery query{.limit = 3};
  do {
    const ModelPage page = catalogue_->search(query).value();
    EXPECT_LE(page.models.size(), 3u);
    for (const auto& m : page.models)
      seen.push_back(m.id);
    // Models that are added between two pages must not change the later pages.
    add(model(static_cast<std::uint8_t>(100 + seen.size())));
    query.after = page.next;
  } while (query.after);
  std::vector<ModelId> expected;
  for (std::uint8_t i = 7; i >= 1; --i)
    expected.push_back(id_of(i));
  EXPECT_EQ(seen, expected);
}

TEST_F(CatalogueSuite, ALastPageThatIsJustFullNamesNoNext) {
  for (std::uint8_t i = 1; i <= 3; ++i)
    add(model(i));
  EXPECT_FALSE(catalogue_->search({.limit = 3}).value().next);
  EXPECT_TRUE(catalogue_->search({.limit = 2}).value().next);
}

TEST_F(CatalogueSuite, TheCursorsOfAllPagesAreThoseOfASearch) {
  for (std::uint8_t i = 1; i <= 6; ++i)
    add(model(i));
  add(model(7, "hidden", ModelState::kDraft));
  EXPECT_EQ(catalogue_->page_cursors(2).value(), (std::vector<ModelId>{id_of(5), id_of(3)}));
  EXPECT_EQ(catalogue_->page_cursors(5).value(), std::vector<ModelId>{id_of(2)});
  EXPECT_EQ(catalogue_->page_cursors(6).value(), std::vector<server::ModelId>{});
}

TEST_F(CatalogueSuite, APageHasAtLeastOneAndAtMostTheStatedNumber) {
  for (std::uint8_t i = 0; i < server::kMaxPage + 2; ++i)
    add(model(i));
  EXPECT_EQ(search({.limit = 0}).size(), 1u);
  EXPECT_EQ(search({.limit = UINT32_MAX}).size(), server::kMaxPage);
}

TEST_F(CatalogueSuite, HidingAndPublishingIsOneStepForModelAndChunks) {
  add(model(1, "x", ModelState::kDraft), {{digest(7), 100, 50}});
  EXPECT_FALSE(catalogue_->find_chunk(digest(7)).value());
  ASSERT_TRUE(catalogue_->set_state(id_of(1), server::ModelState::kPublished));
  EXPECT_EQ(search({}).size(), 1u);
  const auto location = catalogue_->find_chunk(digest(7)).value();
  ASSERT_TRUE(location);
  EXPECT_EQ(location->model, id_of(1));
  EXPECT_EQ(location->place.offset, 100u);
  EXPECT_EQ(location->place.length, 50u);
  ASSERT_TRUE(catalogue_->set_state(id_of(1), server::ModelState::kDraft));
  EXPECT_TRUE(search({}).empty());
  EXPECT_FALSE(catalogue_->find_chunk(digest(7)).value());
}

TEST_F(CatalogueSuite, TheStateOfAnAbsentModelCannotBeSet) {
  const auto result = catalogue_->set_state(id_of(1), ModelState::kPublished);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kState);
}

TEST_F(CatalogueSuite, AChunkIsFoundInEachPublishedModelThatHasIt) {
  add(model(3), {{digest(7), 300, 50}});
  add(model(1), {{digest(7), 100, 50}});
  add(model(2, "x", ModelState::kDraft), {{digest(7), 200, 50}});
  EXPECT_EQ(catalogue_->find_chunk(digest(7)).value().value().model, id_of(1));
  EXPECT_EQ(catalogue_->find_chunk_after(digest(7), id_of(1)).value().value().model, id_of(3));
  EXPECT_FALSE(catalogue_->find_chunk_after(digest(7), id_of(3)).value());
  EXPECT_FALSE(catalogue_->find_chunk_after(digest(8), ModelId()).value());
}

TEST_F(CatalogueSuite, AChunkThatTwoModelsShareIsFoundWhileOneIsPublished) {
  add(model(1), {{digest(7), 100, 50}});
  add(model(2), {{digest(7), 300, 50}});
  ASSERT_TRUE(catalogue_->set_state(id_of(1), server::ModelState::kDraft));
  const auto location = catalogue_->find_chunk(digest(7)).value();
  ASSERT_TRUE(location);
  EXPECT_EQ(location->model, id_of(2));
  EXPECT_EQ(location->place.offset, 300u);
}

TEST_F(CatalogueSuite, TheRevisionChangesWithOwnAndForeignChangesOnly) {
  const auto other = backend_->connect();
  const auto start = catalogue_->revision().value();
  EXPECT_FALSE(catalogue_->find(id_of(1)).value());
  EXPECT_EQ(catalogue_->revision().value(), start);
  add(model(1));
  const auto own = catalogue_->revision().value();
  EXPECT_NE(own, start);
  ASSERT_TRUE(other->set_state(id_of(1), server::ModelState::kDraft));
  EXPECT_NE(catalogue_->revision().value(), own);
}

TEST_F(CatalogueSuite, SeveralConnectionsWriteAtOnceAndLoseNothing) {
  constexpr int kWriters = 4, kEach = 10;
  std::vector<std::thread> writers;
  for (int w = 0; w < kWriters; ++w) {
    writers.emplace_back([this, w] {
      const auto connection = backend_->connect();
      for (int i = 0; i < kEach; ++i) {
        EXPECT_TRUE(connection->add(model(static_cast<std::uint8_t>(w * kEach + i)), {}));
      }
    });
  }
  for (auto& writer : writers)
    writer.join();
  EXPECT_EQ(search({.limit = server::kMaxPage}).size(), static_cast<std::size_t>(kWriters * kEach));
}

TEST_F(CatalogueSuite, ATokenIsFoundByTheStartOfItsHashUntilItIsRevoked) {
  Sha256 hash = digest(7), near = digest(7), far = digest(7);
  near[4] = 0;
  far[3] = 0;
  const TokenRecord token{.id = id_of(1),
                          .role = Role::kOperator,
                          .hash = hash,
                          .label = "Anna's \"laptop\"",
                          .created = 17};
  ASSERT_TRUE(catalogue_->add_token(token));
  ASSERT_TRUE(catalogue_->add_token({id_of(2), server::Role::kViewer, near, "", 18}));
  const auto found = backend_->connect()->tokens_like(hash).value();
  ASSERT_EQ(found.size(), 2u);
  const auto& same = found[found[0].id == id_of(1) ? 0 : 1];
  EXPECT_EQ(same.hash, hash);
  EXPECT_EQ(same.role, Role::kOperator);
  EXPECT_EQ(same.label, token.label);
  EXPECT_EQ(same.created, 17);
  EXPECT_TRUE(catalogue_->tokens_like(far).value().empty());
  ASSERT_TRUE(catalogue_->revoke_token(id_of(1)));
  ASSERT_EQ(catalogue_->tokens_like(hash).value().size(), 1u);
  EXPECT_EQ(catalogue_->tokens_like(hash).value()[0].id, id_of(2));
}

TEST_F(CatalogueSuite, TheTokensInForceAreListedOldestFirst) {
  ASSERT_TRUE(catalogue_->add_token({id_of(2), server::Role::kViewer, digest(2), "b", 2}));
  ASSERT_TRUE(catalogue_->add_token({id_of(1), server::Role::kAdmin, digest(1), "a", 1}));
  ASSERT_TRUE(catalogue_->add_token({id_of(3), server::Role::kViewer, digest(3), "c", 3}));
  ASSERT_TRUE(catalogue_->revoke_token(id_of(3)));
  const auto tokens = catalogue_->tokens().value();
  ASSERT_EQ(tokens.size(), 2u);
  EXPECT_EQ(tokens[0].id, id_of(1));
  EXPECT_EQ(tokens[0].role, Role::kAdmin);
  EXPECT_EQ(tokens[1].label, "b");
}

TEST_F(CatalogueSuite, AModelIsChangedAsAWholeAndByOneAtATime) {
  add(model(1), {{digest(8), 100, 10}});
  server::ModelRecord changed = catalogue_->find(id_of(1)).value().value();
  changed.title = "Another";
  changed.more = {{"description", "\"round\"; DROP TABLE model"}, {"subject", "rings"}};
  changed.unit = "in";
  changed.accuracy = 0.25;
  changed.file = digest(5);
  changed.file_bytes = 77;
  changed.state = ModelState::kDraft;
  changed.public_part = server::PublicPart{.max_level = 3,
                                           .file = digest(6),
                                           .file_bytes = 44,
                                           .head_bytes = 11,
                                           .faces = 9,
                                           .vertices = 8,
                                           .textures = {1, 128, 60}};
  changed.textures = {3, 4'096, 80};
  changed.repairs = "1 duplicate face dropped";
  changed.presentation = {.poster = PresentedView{.zoom = 2},
                          .light = PresentedLight{"raking", 45}};
  const ChunkPlace chunks[] = {{digest(9), 200, 20}};
  const auto before = catalogue_->revision().value();
  ASSERT_TRUE(catalogue_->update(changed, chunks));
  EXPECT_NE(catalogue_->revision().value(), before);
  const ModelRecord found = backend_->connect()->find(id_of(1)).value().value();
  EXPECT_EQ(found.title, changed.title);
  EXPECT_EQ(found.more, changed.more);
  EXPECT_EQ(found.unit, "in");
  EXPECT_EQ(found.accuracy, 0.25);
  EXPECT_EQ(found.file, digest(5));
  EXPECT_EQ(found.file_bytes, 77u);
  EXPECT_EQ(found.state, ModelState::kDraft);
  EXPECT_EQ(found.created, changed.created);
  ASSERT_TRUE(found.public_part);
  EXPECT_EQ(found.public_part->max_level, 3u);
  EXPECT_EQ(found.public_part->file, digest(6));
  EXPECT_EQ(found.public_part->file_bytes, 44u);
  EXPECT_EQ(found.public_part->head_bytes, 11u);
  EXPECT_EQ(found.public_part->faces, 9u);
  EXPECT_EQ(found.public_part->vertices, 8u);
  EXPECT_EQ(found.public_part->textures, (server::TextureSummary{1, 128, 60}));
  EXPECT_EQ(found.textures, (server::TextureSummary{3, 4'096, 80}));
  EXPECT_EQ(found.repairs, changed.repairs);
  EXPECT_EQ(found.presentation, changed.presentation);
  EXPECT_EQ(catalogue_->update(changed, std::nullopt).error().code, ErrorCode::kState);
  ASSERT_TRUE(catalogue_->set_state(id_of(1), server::ModelState::kPublished));
  EXPECT_EQ(catalogue_->update(found, std::nullopt).error().code, ErrorCode::kState);
  EXPECT_FALSE(catalogue_->find_chunk(digest(8)).value());
  EXPECT_EQ(catalogue_->find_chunk(digest(9)).value().value().place.offset, 200u);
  ModelRecord now = catalogue_->find(id_of(1)).value().value();
  now.public_part.reset();
  now.accuracy.reset();
  ASSERT_TRUE(catalogue_->update(now, std::nullopt));
  EXPECT_FALSE(catalogue_->find(id_of(1)).value().value().public_part);
  EXPECT_FALSE(catalogue_->find(id_of(1)).value().value().accuracy);
  EXPECT_TRUE(catalogue_->find_chunk(digest(9)).value());
}

TEST_F(CatalogueSuite, AModelThatIsRemovedIsGoneWithItsChunks) {
  add(model(1), {{digest(8), 100, 10}});
  add(model(2), {{digest(8), 50, 10}});
  const auto before = catalogue_->revision().value();
  const std::uint64_t version = catalogue_->find(id_of(2)).value().value().version;
  EXPECT_EQ(catalogue_->remove(id_of(2), version + 1).error().code, ErrorCode::kState);
  EXPECT_TRUE(catalogue_->find(id_of(2)).value());
  ASSERT_TRUE(catalogue_->remove(id_of(2), version));
  EXPECT_NE(catalogue_->revision().value(), before);
  EXPECT_FALSE(catalogue_->find(id_of(2)).value());
  EXPECT_EQ(catalogue_->find_chunk(digest(8)).value().value().model, id_of(1));
  EXPECT_EQ(catalogue_->remove(id_of(2), std::nullopt).error().code, ErrorCode::kState);
  ASSERT_TRUE(catalogue_->remove(id_of(1), std::nullopt));
  EXPECT_FALSE(catalogue_->find_chunk(digest(8)).value());
}

TEST_F(CatalogueSuite, TheFilesAreThoseThatModelsAndDraftsNameByModel) {
  EXPECT_TRUE(catalogue_->files().value().empty());
  server::ModelRecord second = model(2, "A draft", ModelState::kDraft);
  second.file = digest(1);
  ModelRecord third = model(3);
  third.public_part = server::PublicPart{.file = digest(4), .file_bytes = 44};
  add(model(1)), add(second), add(third);
  const auto listed = catalogue_->files().value();
  std::set<std::tuple<server::ModelId, Sha256, std::uint64_t>> files;
  for (const NamedFile& file : listed)
    files.emplace(file.model, file.file, file.bytes);
  const decltype(files) expected = {{id_of(1), digest(1), 1'000},
                                    {id_of(2), digest(1), 1'000},
                                    {id_of(3), digest(3), 1'000},
                                    {id_of(3), digest(4), 44}};
  EXPECT_EQ(files, expected);
  EXPECT_EQ(listed.size(), 4u);
  EXPECT_EQ(server::models_in(listed), 3u);
}

TEST_F(CatalogueSuite, ATokenIsAddedOnceAndRevokedOnce) {
  const TokenRecord token{.id = id_of(1), .role = Role::kAdmin, .hash = digest(1)};
  ASSERT_TRUE(catalogue_->add_token(token));
  EXPECT_EQ(catalogue_->add_token(token).error().code, ErrorCode::kState);
  EXPECT_EQ(catalogue_->add_token({id_of(2), Role::kAdmin, digest(1), "", 0}).error().code,
            ErrorCode::kState);
  EXPECT_EQ(catalogue_->revoke_token(id_of(2)).error().code, ErrorCode::kState);
  ASSERT_TRUE(catalogue_->revoke_token(id_of(1)));
  EXPECT_EQ(catalogue_->revoke_token(id_of(1)).error().code, ErrorCode::kState);
}

TEST_F(CatalogueSuite, TellsWhichChunksOfAPublishedModelItHides) {
  std::vector<std::vector<Sha256>> told;
  catalogue_->when_hidden([&](std::vector<Sha256> chunks) {
    ASSERT_TRUE(catalogue_->revision());  // the callback may use the catalogue
    told.push_back(std::move(chunks));
  });
  const std::vector<std::vector<Sha256>> once = {{digest(7)}};
  const auto expect_told = [&](const char* change, const std::vector<std::vector<Sha256>>& wanted) {
    EXPECT_EQ(std::exchange(told, {}), wanted) << change;
  };
  const std::vector<server::ChunkPlace> first = {{digest(7), 0, 10}}, second = {{digest(8), 0, 10}};
  add(model(1), first);
  ASSERT_TRUE(catalogue_->update(model(1, "A new title"), std::nullopt));
  ASSERT_TRUE(catalogue_->set_state(id_of(1), ModelState::kPublished));
  expect_told("a title and a publication hide nothing", {});
  EXPECT_EQ(catalogue_->public_chunks(id_of(1)).value(), once.front());
  ASSERT_TRUE(catalogue_->set_state(id_of(1), ModelState::kDraft));
  expect_told("withdrawal", once);
  EXPECT_TRUE(catalogue_->public_chunks(id_of(1)).value().empty());
  ASSERT_TRUE(catalogue_->set_state(id_of(1), ModelState::kDraft));
  expect_told("a draft has nothing to hide", {});
  ASSERT_TRUE(catalogue_->set_state(id_of(1), ModelState::kPublished));
  EXPECT_FALSE(catalogue_->update(model(1), std::span<const server::ChunkPlace>(second)));
  expect_told("an update that is refused", {});
  ASSERT_TRUE(catalogue_->update(*catalogue_->find(id_of(1)).value(),
                                 std::span<const server::ChunkPlace>(second)));
  expect_told("replacement", once);
  ASSERT_TRUE(catalogue_->remove(id_of(1), std::nullopt));
  expect_told("removal", {{digest(8)}});
}

}  // namespace
}  // namespace vitrine::test
