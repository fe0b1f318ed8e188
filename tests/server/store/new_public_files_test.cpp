// SPDX-License-Identifier: Apache-2.0
#include "server/store/new_public_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/store/change.h"
#include "server/store/installation.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

ModelId add(const Installation& in, const std::string& title, ModelState state) {
  const auto file = test::tiny_pmesh("base of " + title, "chunk");
  return publish(*in.store, *in.catalogue, file.bytes, {.title = title}, {.state = state})
      .value()
      .id;
}

TEST(NewPublicFiles, AreThoseOfAllModelsAfterAStartAndLaterThoseThatAnyProcessPublishes) {
  const test::TemporaryFolder folder;
  const Installation in = open_installation({.folder = folder.path()}).value();
  const Installation other = open_installation({.folder = folder.path()}).value();
  const ModelId first = add(in, "first", ModelState::kPublished);
  const ModelId second = add(in, "second", ModelState::kPublished);
  add(in, "draft", ModelState::kDraft);
  NewPublicFiles files(*in.catalogue);
  EXPECT_THAT(files.find(), UnorderedElementsAre(first, second));
  EXPECT_THAT(files.find(), IsEmpty());
  const ModelId third = add(other, "third", ModelState::kPublished);
  EXPECT_THAT(files.find(), ElementsAre(third));
  const auto file = test::tiny_pmesh("another base", "chunk");
  ASSERT_TRUE(replace(*other.store, *other.catalogue, file.bytes, {}, {.id = first}));
  EXPECT_THAT(files.find(), ElementsAre(first));
}

}  // namespace
}  // namespace vitrine::server
