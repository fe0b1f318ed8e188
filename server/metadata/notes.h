// SPDX-License-Identifier: Apache-2.0
// Checks the notes on a model's surface and the tours through them, which clients send as JSON. The
// catalogue stores the JSON as it is, and viewers read it.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "server/metadata/presentation.h"

namespace vitrine::server {

inline constexpr std::size_t kMostNotes = 100, kMostTours = 20, kMostSteps = 100,
                             kMostLanguages = 12;
// Largest sizes in bytes.
inline constexpr std::size_t kMaxNoteTitle = 200, kMaxNoteText = 8'000, kMaxNoteUrl = 1'000;

// Calls `wrong` for each fault of a list of notes. A note has an ID, a position and optionally a
// normal in the coordinates of the model's file, and texts in one or more languages, each
// optionally with the URL of a sound. The note optionally has the URL of a picture, and the view,
// light and section to show with the note. A section is an axis of the presented model and a
// position from 0 to 200: the start and the end of the model's box along that axis.
void check_notes(const nlohmann::json& notes, const WrongField& wrong);

// Calls `wrong` for each fault of a list of tours. A tour has an ID, titles in one or more
// languages, and steps. Each step names a note; viewers skip notes that no longer exist.
void check_tours(const nlohmann::json& tours, const WrongField& wrong);

}  // namespace vitrine::server
