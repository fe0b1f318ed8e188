// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/wants.h"

#include <fmt/format.h>

#include "server/cli/support/levels.h"

namespace vitrine::server::cli {
namespace {

Unexpected unmet(std::string why) {
  return fail(ErrorCode::kState, std::move(why));
}

}  // namespace

tl::expected<std::optional<Want>, Fault> read_want(const Arguments& arguments) {
  const auto level = arguments.number("--level", 0, 1'000);
  if (!level) return tl::unexpected(level.error());
  const auto triangles = arguments.number("--triangles", 1, UINT64_MAX);
  if (!triangles) return tl::unexpected(triangles.error());
  const auto bytes = arguments.number("--bytes", 1, UINT64_MAX);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto error = arguments.distance("--error");
  if (!error) return tl::unexpected(error.error());

  std::vector<Want> wants;
  if (*level) wants.emplace_back(WantLevel{static_cast<std::uint32_t>(**level)});
  if (*triangles) wants.emplace_back(WantTriangles{**triangles});
  if (*bytes) wants.emplace_back(WantBytes{**bytes});
  if (*error) wants.emplace_back(WantError{**error});
  if (wants.size() > 1)
    return misused("--level, --triangles, --bytes and --error exclude each other; give one");
  return wants.empty() ? std::nullopt : std::optional(wants[0]);
}

Expected<void> check_want(const Manifest& m, const Want& want) {
  const LevelInfo &coarsest = m.levels.front(), &finest = m.levels.back();
  if (const auto* w = std::get_if<WantLevel>(&want); w && w->level >= m.levels.size()) {
    return unmet(
        fmt::format("there is no level {}; the finest is {}", w->level, m.levels.size() - 1));
  }
  if (const auto* w = std::get_if<WantTriangles>(&want); w && w->triangles < coarsest.faces) {
    return unmet(fmt::format("the coarsest level has {} triangles; ask for at least that many",
                             coarsest.faces));
  }
  if (const auto* w = std::get_if<WantBytes>(&want); w && w->bytes < m.head_bytes()) {
    return unmet(fmt::format("the coarsest level takes {} bytes; ask for at least that many",
                             m.head_bytes()));
  }
  if (const auto* w = std::get_if<WantError>(&want); w && w->error < finest.max_error) {
    return unmet(fmt::format("the finest level has an error of {}; ask for at least that much",
                             bound_text(finest.max_error)));
  }
  return {};
}

}  // namespace vitrine::server::cli
