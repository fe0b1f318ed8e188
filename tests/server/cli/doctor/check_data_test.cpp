// SPDX-License-Identifier: Apache-2.0
// Tests the doctor's findings about a data folder.
#include "server/cli/doctor/checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/store/change.h"
#include "server/store/installation.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using testing::HasSubstr;

TEST(CheckData, AlsoFindsAMissingPublicPart) {
  const test::TemporaryFolder folder;
  const Installation in = open_installation({.folder = folder.path()}).value();
  const auto file = test::tiny_pmesh("base", "chunk").bytes;
  ModelRecord model;
  for (const char* title : {"whole", "capped"}) {
    const ModelId id = publish(*in.store, *in.catalogue, file, {.title = title}).value().id;
    model = in.catalogue->find(id).value().value();
  }
  model.public_part = PublicPart{.max_level = 0};
  model = change(*in.store, *in.catalogue, model).value();
  const Finding whole = check_data(folder.path()).back();
  EXPECT_EQ(whole.verdict, Verdict::kOk) << whole.detail;
  EXPECT_THAT(whole.detail, HasSubstr("2 models"));
  model = in.catalogue->find(model.id).value().value();
  ASSERT_TRUE(in.store->remove(model.public_part.value().file));
  const Finding less = check_data(folder.path()).back();
  EXPECT_EQ(less.verdict, Verdict::kFail);
  EXPECT_THAT(less.detail, HasSubstr("the files of 1 of 2 models are missing, first of " +
                                     model.id.to_string()));
}

}  // namespace
}  // namespace vitrine::server
