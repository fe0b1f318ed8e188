// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql_model.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

namespace vitrine::server {
namespace {

using sql::count;
using sql::number;
using sql::Statement;

std::map<std::string, std::string> read_more(const std::string& text) {
  std::map<std::string, std::string> more;
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return more;
  for (const auto& [name, value] : json.items()) {
    if (value.is_string()) more[name] = value.get<std::string>();
  }
  return more;
}

// Reads a TextureSummary from three columns, beginning with column `first`.
TextureSummary read_textures(const Statement& row, int first) {
  return {.count = static_cast<std::uint32_t>(row.integer(first)),
          .largest_side = static_cast<std::uint32_t>(row.integer(first + 1)),
          .bytes = count(row, first + 2)};
}

std::optional<PublicPart> read_public_part(const Statement& row) {
  if (row.is_null(16)) return std::nullopt;
  return PublicPart{.max_level = static_cast<std::uint32_t>(row.integer(16)),
                    .file = row.blob<32>(17),
                    .file_bytes = count(row, 18),
                    .head_bytes = count(row, 19),
                    .faces = count(row, 20),
                    .vertices = count(row, 21),
                    .textures = read_textures(row, 25)};
}

}  // namespace

ModelRecord read_model(const Statement& row) {
  ModelRecord model;
  model.id = ModelId::from_bytes(row.blob<16>(0));
  model.state = row.integer(1) == 1 ? ModelState::kPublished : ModelState::kDraft;
  model.created = row.integer(2);
  model.title = row.text(3);
  model.creator = row.text(4);
  model.rights = row.text(5);
  model.licence = row.text(6);
  model.unit = row.text(7);
  model.file = row.blob<32>(8);
  model.file_bytes = count(row, 9);
  model.head_bytes = count(row, 10);
  model.faces = count(row, 11);
  model.vertices = count(row, 12);
  model.more = read_more(row.text(13));
  if (!row.is_null(14)) model.accuracy = row.real(14);
  model.version = count(row, 15);
  model.public_part = read_public_part(row);
  model.textures = read_textures(row, 22);
  model.repairs = row.text(28);
  model.presentation = from_stored_text(row.text(29));
  if (!row.is_null(30)) model.notes = count(row, 30);
  return model;
}

std::string more_text(const ModelRecord& model) {
  return nlohmann::json(model.more).dump();
}

namespace {

void bind_public_part(Statement& row, const std::optional<PublicPart>& part) {
  if (!part) {
    for (int i = 0; i < 6; ++i)
      row.bind_null();
    return;
  }
  row.bind(number(part->max_level)).bind(part->file).bind(number(part->file_bytes));
  row.bind(number(part->head_bytes)).bind(number(part->faces)).bind(number(part->vertices));
}

void bind_textures(Statement& row, const TextureSummary& textures) {
  row.bind(std::int64_t{textures.count}).bind(std::int64_t{textures.largest_side});
  row.bind(number(textures.bytes));
}

}  // namespace

void bind_model(Statement& row, const ModelRecord& m) {
  row.bind(m.id.bytes()).bind(static_cast<std::int64_t>(m.state)).bind(m.created);
  row.bind(m.title).bind(m.creator).bind(m.rights).bind(m.licence).bind(m.unit).bind(m.file);
  row.bind(number(m.file_bytes)).bind(number(m.head_bytes));
  row.bind(number(m.faces)).bind(number(m.vertices)).bind(more_text(m));
  if (m.accuracy) {
    row.bind_real(*m.accuracy);
  } else {
    row.bind_null();
  }
  row.bind(number(m.version));
  bind_public_part(row, m.public_part);
  bind_textures(row, m.textures);
  bind_textures(row, m.public_part ? m.public_part->textures : TextureSummary());
  row.bind(m.repairs).bind(stored_text(m.presentation));
}

std::string select_models(std::string_view which) {
  return fmt::format("SELECT {}, {} FROM model WHERE {}", kModelColumns, kFurtherColumns, which);
}

}  // namespace vitrine::server
