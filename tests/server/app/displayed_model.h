// SPDX-License-Identifier: Apache-2.0
// The real daemon with a model on display that was really built.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>

#include "server/jobs/build_model.h"
#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/daemon.h"
#include "support/http_client.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

// A wavy sheet of 2 * 59 * 59 = 6962 triangles as OBJ.
inline std::string wavy_sheet() {
  constexpr int kSide = 60;
  std::string text;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
              std::to_string(std::sin(0.3 * x) * std::cos(0.2 * y)) + "\n";
    }
  }
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const int a = y * kSide + x + 1, b = a + 1, c = a + kSide, d = c + 1;
      for (const auto& [p, q, r] : {std::array{a, b, d}, std::array{a, d, c}}) {
        text += "f " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
      }
    }
  }
  return text;
}

inline const BuildResult& built_model() {
  static const BuildResult result = [] {
    const std::string text = wavy_sheet();
    auto model = build_model({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, {},
                             [](std::string_view, double) {});
    if (!model) throw std::runtime_error(model.error().message);
    return std::move(*model);
  }();
  return result;
}

class DisplayedModel {
 public:
  explicit DisplayedModel(const ModelMetadata& metadata = {},
                          const std::vector<std::string>& settings = {})
      : id(publish_in(folder.path(), metadata)),
        api("/api/v1/models/" + id),
        daemon(folder.path(), settings) {}

  std::uint16_t port() const { return daemon.port(); }

  const std::vector<LevelInfo>& levels = built_model().report.manifest.levels;
  const TemporaryFolder folder;
  const std::string id, api;
  Daemon daemon;

 private:
  static std::string publish_in(const std::filesystem::path& data, const ModelMetadata& metadata) {
    Installation installation = open_installation(data).value();
    const auto published =
        publish(*installation.store, *installation.catalogue, built_model().file, metadata);
    if (!published) throw std::runtime_error(published.error().message);
    return published->id.to_string();
  }
};

}  // namespace vitrine::test
