// SPDX-License-Identifier: Apache-2.0
#include "server/config/live_settings.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

Settings with_url(std::string url) {
  Settings settings;
  settings.public_url = std::move(url);
  return settings;
}

TEST(LiveSettings, ReadersKeepTheSettingsThatWereReplaced) {
  LiveSettings live(with_url("https://first"));
  const Settings& first = live.get();
  for (int i = 0; i < 100; ++i)
    live.replace(with_url("https://other"));
  live.replace(with_url("https://last"));
  EXPECT_EQ(first.public_url, "https://first");
  EXPECT_EQ(live.get().public_url, "https://last");
}

}  // namespace
}  // namespace vitrine::server
