// SPDX-License-Identifier: Apache-2.0
// The rows of models in an SQL database.
#pragma once

#include "server/catalogue/catalogue.h"
#include "server/catalogue/sql.h"

namespace vitrine::server {

// The columns of a model, in the order in which read_model() and bind_model() use them.
inline constexpr std::string_view kModelColumns =
    "id, state, created, title, creator, rights, licence, unit, file, file_bytes, head_bytes, "
    "faces, vertices, more, accuracy, version, public_max_level, public_file, public_file_bytes, "
    "public_head_bytes, public_faces, public_vertices, texture_count, texture_side, texture_bytes, "
    "public_texture_count, public_texture_side, public_texture_bytes, repairs, presentation";

// The columns of a model that other tables determine. They follow kModelColumns in each SELECT.
inline constexpr std::string_view kFurtherColumns =
    "(SELECT entries FROM annotation WHERE annotation.model = model.id AND kind = 0)";

// Returns a SELECT statement for kModelColumns and kFurtherColumns. `which` is the text after
// WHERE: a condition, and further clauses.
std::string select_models(std::string_view which);

ModelRecord read_model(const sql::Statement& row);
void bind_model(sql::Statement& row, const ModelRecord& model);

// Returns ModelRecord::more as JSON text, which is how the database stores it.
std::string more_text(const ModelRecord& model);

}  // namespace vitrine::server
