// SPDX-License-Identifier: Apache-2.0
#include "server/store/s3_store.h"

#include <fmt/core.h>

#include <algorithm>
#include <ctime>

#include "codec/core/parse_number.h"
#include "server/catalogue/id.h"
#include "server/content/percent_encoding.h"
#include "server/store/local_copy.h"
#include "server/store/s3_answers.h"
#include "server/store/s3_client.h"

namespace vitrine::server {
namespace {

const std::string kObjects = "objects/", kGrace = "grace/", kProbe = "probe/";

std::string object_key(const Sha256& name) {
  return kObjects + to_hex(name);
}

std::string grace_key(const Sha256& name) {
  return kGrace + to_hex(name);
}

// Returns the time in the response's Date field, or this machine's time if the field is missing.
std::int64_t time_of(const RemoteAnswer& answer) {
  std::tm time{};
  const std::string date = answer.field("date");
  const bool is_told = ::strptime(date.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &time) != nullptr;
  return is_told ? ::timegm(&time) : std::time(nullptr);
}

bool is_absent(const RemoteAnswer& answer) {
  if (answer.status != 404) return false;
  const std::string error = s3_error(answer.body);  // empty in a response to HEAD
  return error.empty() || error == "NoSuchKey";
}

}  // namespace

Expected<std::unique_ptr<S3Store>> S3Store::open(S3Options options) {
  std::unique_ptr<S3Store> store(new S3Store(std::move(options)));
  if (auto usable = store->probe(); !usable) return tl::unexpected(usable.error());
  return store;
}

Expected<void> S3Store::probe() {
  const std::string name = to_string(generate_ulid()), key = kProbe + name;
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(name.data()), name.size());
  if (auto written = write(key, bytes); !written) return written;
  const auto read = client_.ask({.key = key});
  if (!read) return tl::unexpected(read.error());
  if (read->status != 200 || read->body != name) return client_.refused("read an object", *read);
  if (auto listed = list(kProbe); !listed) return tl::unexpected(listed.error());
  return remove_key(key);
}

Expected<void> S3Store::write(const std::string& key, std::span<const std::uint8_t> bytes) {
  return s3_upload(client_, key, bytes, options_.part_bytes);
}

Expected<void> S3Store::remove_key(const std::string& key) {
  const auto answer = client_.ask({.method = "DELETE", .key = key});
  if (!answer) return tl::unexpected(answer.error());
  if (answer->status / 100 == 2 || is_absent(*answer)) return {};
  return client_.refused("remove an object", *answer);
}

Expected<bool> S3Store::put(const Sha256& name, std::span<const std::uint8_t> bytes) {
  if (sha256(bytes) != name) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the bytes are not those of object {}; send them again", to_hex(name)));
  }
  const auto before = size_of(name);
  if (!before) return tl::unexpected(before.error());
  if (*before == bytes.size()) {
    const auto state = check(name, [](std::uint64_t) { return true; });
    if (state && *state == ObjectState::kIntact) {
      auto begun = begin_grace(name);
      return begun ? Expected<bool>(false) : tl::unexpected(begun.error());
    }
  }
  auto written = write(object_key(name), bytes);
  return written ? Expected<bool>(true) : tl::unexpected(written.error());
}

Expected<void> S3Store::remove(const Sha256& name) {
  return remove_key(object_key(name));
}

Expected<void> S3Store::begin_grace(const Sha256& name) {
  return write(grace_key(name), {});
}

Expected<S3Store::Listing> S3Store::list(const std::string& folder) {
  const std::string start = client_.address().prefix + folder;
  Listing listing;
  std::string next;
  do {
    const std::string token =
        next.empty() ? "" : fmt::format("continuation-token={}&", percent_encoded(next));
    const auto answer = client_.ask(
        {.query = fmt::format("{}list-type=2&prefix={}", token, percent_encoded(start))});
    if (!answer) return tl::unexpected(answer.error());
    const auto page = s3_objects(answer->body);
    if (answer->status != 200 || !page) return client_.refused("list the objects", *answer);
    if (next.empty()) listing.now = time_of(*answer);
    for (const S3Entry& entry : page->entries) {
      Sha256 name{};
      if (from_hex(std::string_view(entry.key).substr(start.size()), name))
        listing.entries[name] = entry.when;
    }
    next = page->next;
  } while (!next.empty());
  return listing;
}

Expected<void> S3Store::give_up_uploads(std::int64_t begun_before) {
  const std::string& prefix = client_.address().prefix;
  const auto answer =
      client_.ask({.query = fmt::format("prefix={}&uploads=", percent_encoded(prefix + kObjects))});
  if (!answer) return tl::unexpected(answer.error());
  const auto page = s3_uploads(answer->body);
  if (answer->status != 200 || !page) return client_.refused("list the uploads", *answer);
  for (const S3Entry& entry : page->entries) {
    if (entry.when > begun_before) continue;
    const std::string key = entry.key.substr(prefix.size());
    if (auto done = s3_give_up(client_, key, entry.upload); !done) return done;
  }
  return {};
}

// Lists the objects first and the grace marks afterwards, so that it also sees marks that are set
// while the objects are being listed.
Expected<std::size_t> S3Store::sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                                     const ExclusiveLock& lock) {
  const auto objects = list(kObjects);
  if (!objects) return tl::unexpected(objects.error());
  const auto marks = list(kGrace);
  if (!marks) return tl::unexpected(marks.error());
  const std::int64_t last = objects->now - grace.count();
  std::size_t swept = 0;
  for (const auto& [name, when] : objects->entries) {
    const auto mark = marks->entries.find(name);
    const bool is_late = mark == marks->entries.end() || mark->second <= last;
    if (keep.contains(name) || when > last || !is_late) continue;
    if (auto held = lock.check(); !held) return tl::unexpected(held.error());
    if (auto gone = remove(name); !gone) return tl::unexpected(gone.error());
    ++swept;
  }
  for (const auto& [name, when] : marks->entries) {
    if (when > last) continue;
    if (auto held = lock.check(); !held) return tl::unexpected(held.error());
    if (auto gone = remove_key(grace_key(name)); !gone) return tl::unexpected(gone.error());
  }
  if (auto done = give_up_uploads(last); !done) return tl::unexpected(done.error());
  return swept;
}

// Downloads the object. If the received bytes are damaged, downloads the object once more.
Expected<std::unique_ptr<Object>> S3Store::open(const Sha256& name) const {
  for (int attempt = 0; attempt < 2; ++attempt) {
    auto copy = LocalCopy::create(options_.copies);
    if (!copy) return tl::unexpected(copy.error());
    const auto answer = client_.ask({.key = object_key(name),
                                     .take = [&](auto bytes) { return copy->append(bytes); },
                                     .restart = [&] { copy->restart(); }});
    if (const auto fault = copy->fault()) return tl::unexpected(*fault);
    if (!answer) return tl::unexpected(answer.error());
    if (is_absent(*answer)) return nullptr;
    if (answer->status != 200) return client_.refused("read an object", *answer);
    auto object = std::move(*copy).finish(name);
    if (!object || *object != nullptr) return object;
  }
  return fail(ErrorCode::kState,
              fmt::format("object {} is damaged in s3://{}; put it back with 'vitrine repair'",
                          to_hex(name), client_.address().bucket));
}

// Hashes the bytes as they arrive, without keeping a copy. If the received bytes are damaged,
// downloads them once more.
Expected<ObjectState> S3Store::check(const Sha256& name, const OnPiece& on_piece) const {
  for (int attempt = 0; attempt < 2; ++attempt) {
    Sha256Hasher hasher;
    const auto answer = client_.ask({.key = object_key(name),
                                     .take =
                                         [&](std::span<const std::uint8_t> bytes) {
                                           hasher.add(bytes);
                                           return on_piece(bytes.size());
                                         },
                                     .restart = [&] { hasher = {}; }});
    if (!answer) return tl::unexpected(answer.error());
    if (is_absent(*answer)) return ObjectState::kMissing;
    if (answer->status != 200) return client_.refused("read an object", *answer);
    if (hasher.finish() == name) return ObjectState::kIntact;
  }
  return ObjectState::kDamaged;
}

Expected<std::optional<std::uint64_t>> S3Store::size_of(const Sha256& name) const {
  const auto answer = client_.ask({.method = "HEAD", .key = object_key(name)});
  if (!answer) return tl::unexpected(answer.error());
  if (is_absent(*answer)) return std::nullopt;
  const auto size = parse_number<std::uint64_t>(answer->field("content-length"));
  if (answer->status == 200 && size) return *size;
  return client_.refused("look at an object", *answer);
}

}  // namespace vitrine::server
