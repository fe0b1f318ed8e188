// SPDX-License-Identifier: Apache-2.0
#include "server/store/publish.h"

#include <chrono>

#include "server/metadata/fields.h"
#include "server/metadata/text.h"
#include "server/store/stored_file.h"

namespace vitrine::server {
namespace {

std::int64_t now_in_milliseconds() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

ModelRecord new_record(const StoredFile& file, const ModelMetadata& metadata, const PublishAs& as) {
  ModelRecord record;
  record.id = as.id.value_or(ModelId::generate());
  record.state = as.state;
  record.created = now_in_milliseconds();
  record.title = metadata.title;
  record.creator = metadata.creator;
  record.rights = metadata.rights;
  record.licence = metadata.licence;
  record.more = metadata.more;
  record.repairs = as.repairs;
  describe(record, file);
  return record;
}

Expected<void> check_text(const char* name, const std::string& text) {
  if (is_line(text)) return {};
  return fail(ErrorCode::kBadInput, std::string("the ") + name +
                                        " is not one line of UTF-8 of at most 4096 bytes; give "
                                        "another");
}

Expected<void> check_paragraphs(const char* name, const std::string& text) {
  if (is_paragraphs(text)) return {};
  return fail(ErrorCode::kBadInput,
              std::string("the ") + name + " is not UTF-8 of at most 16,384 bytes; give another");
}

// Returns the model with the ID of `record`, if it exists. Otherwise returns a published model with
// the same file and texts, so that the same content is not published twice. A draft is always added
// as a new model.
Expected<std::optional<ModelRecord>> find_earlier(Catalogue& catalogue, const ModelRecord& record) {
  auto same = catalogue.find(record.id);
  if (!same || *same || record.state == ModelState::kDraft) return same;
  return catalogue.find_same(record);
}

// Stores the repairs of a new build of the same file. Leaves the stored repairs unchanged if
// `repairs` is empty: the .pmesh file itself may have been published again, without its repairs.
Expected<void> keep_repairs(Catalogue& catalogue, ModelRecord model, const std::string& repairs) {
  if (repairs.empty() || repairs == model.repairs) return {};
  model.repairs = repairs;
  return catalogue.update(model, std::nullopt);
}

// Adds the model of the stored file to the catalogue.
Expected<Publication> add(Catalogue& catalogue, const ModelRecord& record, const StoredFile& stored,
                          const std::optional<JobClaim>& by) {
  const auto same = find_earlier(catalogue, record);
  if (!same) return tl::unexpected(same.error());
  if (*same) {
    // If the file was lost or damaged before, sets the model's state again. This changes the
    // revision, so that readers reopen the repaired file.
    const bool is_mended = stored.is_new || stored.is_repaired;
    // The publication succeeds even if the repairs cannot be stored, for example because the model
    // was changed meanwhile. Only kIo makes it fail.
    if (auto kept = keep_repairs(catalogue, **same, record.repairs);
        !kept && kept.error().code == ErrorCode::kIo)
      return tl::unexpected(kept.error());
    const auto told =
        is_mended ? catalogue.set_state((*same)->id, (*same)->state) : Expected<void>{};
    if (!told) return tl::unexpected(told.error());
    return Publication{.id = (*same)->id, .is_new = false};
  }
  if (auto added = catalogue.add(record, stored.blocks(), by); !added)
    return tl::unexpected(added.error());
  return Publication{.id = record.id};
}

}  // namespace

Expected<void> check_texts(const ModelMetadata& metadata) {
  if (auto good = check_text("title", metadata.title); !good) return good;
  if (auto good = check_text("creator", metadata.creator); !good) return good;
  if (auto good = check_paragraphs("rights statement", metadata.rights); !good) return good;
  if (auto good = check_text("licence", metadata.licence); !good) return good;
  for (const auto& [name, text] : metadata.more) {
    auto good = has_paragraphs(name) ? check_paragraphs(name.c_str(), text)
                                     : check_text(name.c_str(), text);
    if (!good) return good;
    if (const auto expected = expected_text(name, text))
      return fail(ErrorCode::kBadInput, "the " + name + " is not " + *expected + "; correct it");
  }
  return {};
}

Expected<Publication> publish(ObjectStore& store, Catalogue& catalogue,
                              std::span<const std::uint8_t> pmesh, const ModelMetadata& metadata,
                              const PublishAs& as) {
  if (auto good = check_texts(metadata); !good) return tl::unexpected(good.error());
  const auto lock = store.lock();
  if (!lock) return tl::unexpected(lock.error());
  auto file = to_be_stored(pmesh);
  if (!file) return tl::unexpected(file.error());
  const ModelRecord record = new_record(*file, metadata, as);
  const NamedFile named{record.id, record.file, record.file_bytes};
  const auto room = Quota::reserve(as.quota, {&named, 1}, as.upload);
  if (!room) return tl::unexpected(room.error());
  if (auto stored = store_file(store, *file, pmesh); !stored) return tl::unexpected(stored.error());
  if (auto held = (*lock)->check(); !held) return tl::unexpected(held.error());
  auto published = add(catalogue, record, *file, as.by);
  // If adding the model failed with kIo, the catalogue may nevertheless refer to the file, so the
  // file must stay.
  const bool is_unnamed = !published && published.error().code != ErrorCode::kIo;
  if (is_unnamed && file->is_new && (*lock)->check()) static_cast<void>(store.remove(file->name));
  return published;
}

}  // namespace vitrine::server
