// SPDX-License-Identifier: Apache-2.0
#include "codec/package/unpack.h"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <memory>

#include "codec/files/companions.h"
#include "codec/package/gunzip.h"
#include "codec/package/utf8_names.h"

namespace vitrine::inline codec {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Archive = std::unique_ptr<archive, decltype(&archive_read_free)>;

constexpr int kDeepest = 3;  // maximum depth of nested packages

std::string_view text_in(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_zip(std::span<const std::uint8_t> bytes) {
  return text_in(bytes).starts_with("PK\3\4");
}

// Whether the bytes start with the header of a Unix V7 tar file. The header has no signature, but a
// name and the sum of its bytes in octal digits. The sum counts its own field as blanks.
bool is_old_tar(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kHeader = 512, kSum = 148, kDigits = 6, kField = 8;
  if (bytes.size() < kHeader || bytes[0] == 0) return false;
  unsigned sum = kField * ' ', stated = 0;
  for (std::size_t i = 0; i < kHeader; ++i)
    sum += i < kSum || i >= kSum + kField ? bytes[i] : 0;
  for (const char c : text_in(bytes.subspan(kSum, kDigits))) {
    if (c != ' ' && (c < '0' || c > '7')) return false;
    stated = c == ' ' ? stated : stated * 8 + static_cast<unsigned>(c - '0');
  }
  return stated == sum;
}

bool is_tar(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kSignature = 257;
  return (bytes.size() > kSignature && text_in(bytes.subspan(kSignature)).starts_with("ustar")) ||
         is_old_tar(bytes);
}

std::string printable(std::string_view text) {
  std::string out = as_utf8(text);
  std::ranges::replace_if(
      out, [](unsigned char c) { return c < ' ' || c == 0x7F; }, '?');
  return out;
}

Unexpected refused(ErrorCode code, const std::string& fault) {
  return fail(code, "the package " + fault);
}

// Keeps only the first line of libarchive's message, in printable form, because the message may
// contain names from the package.
Unexpected damaged(archive* handle) {
  const char* said = archive_error_string(handle);
  std::string why = said != nullptr ? said : "its contents are unreadable";
  why.resize(std::min(why.find('\n'), why.size()));
  return refused(ErrorCode::kBadInput,
                 "is damaged: " + printable(why) + "; download or pack it again");
}

// Returns the path of an entry with slashes between its parts, as UTF-8 without control characters.
// Returns an empty string if the path cannot be read.
std::string path_of(archive_entry* entry) {
  const char* name = archive_entry_pathname(entry);
  std::string path = printable(name == nullptr ? "" : name);
  std::ranges::replace(path, '\\', '/');
  return path;
}

bool leads_outside(const std::string& path) {
  const bool has_drive = path.size() > 1 && path[1] == ':';
  const std::string parts = '/' + path + '/';
  return path.starts_with('/') || has_drive || parts.find("/../") != parts.npos;
}

bool is_plain_file(archive_entry* entry) {
  return archive_entry_filetype(entry) == AE_IFREG && archive_entry_hardlink(entry) == nullptr &&
         archive_entry_symlink(entry) == nullptr;
}

// Checks the header of an entry: the path, the encryption and the compression method.
Expected<void> check_head(archive* handle, archive_entry* entry, const std::string& path) {
  if (path.empty())
    return refused(ErrorCode::kBadInput, "has a file without a readable name; pack it again");
  if (path.size() > kMostPathBytes)
    return refused(ErrorCode::kLimit, "has a path of over " + std::to_string(kMostPathBytes) +
                                          " bytes; pack it again with shorter names");
  if (leads_outside(path))
    return refused(ErrorCode::kBadInput, "has the file \"" + path +
                                             "\", which lies outside of it; pack it again with "
                                             "relative names");
  if (archive_entry_is_encrypted(entry) != 0)
    return refused(ErrorCode::kUnsupported, "is encrypted; pack it again without a password");
  const std::string_view format = archive_format_name(handle);
  const bool is_known = !format.starts_with("ZIP") || format.ends_with("(deflation)") ||
                        format.ends_with("(uncompressed)");
  if (!is_known)
    return refused(ErrorCode::kUnsupported, "is compressed by a rare method, " +
                                                std::string(format) +
                                                "; pack it again as an ordinary zip");
  return {};
}

class Unpacker {
 public:
  Unpacker(std::uint64_t most, const std::function<bool(std::string_view)>& keeps_whole)
      : left_(most), most_(most), keeps_whole_(keeps_whole) {}

  // Unpacks a package. `prefix` is put before the paths in it. `depth` is the number of packages
  // that contain it.
  Expected<void> unpack(std::span<const std::uint8_t> package, const std::string& prefix,
                        int depth) {
    if (!is_gzip(package)) return unpack_archive(package, prefix, depth);
    auto bytes = gunzip(package, left_);
    if (!bytes) return tl::unexpected(bytes.error());
    left_ -= bytes->size();
    const bool has_suffix = prefix.ends_with(".gz");
    return add(
        PackedFile{prefix.substr(0, prefix.size() - (has_suffix ? 3 : 0)), *std::move(bytes)},
        depth);
  }

  std::vector<PackedFile> files() && { return std::move(files_); }

 private:
  Expected<void> unpack_archive(std::span<const std::uint8_t> package, const std::string& prefix,
                                int depth) {
    const Utf8Names names;
    const Archive handle(archive_read_new(), archive_read_free);
    archive_read_support_format_zip_seekable(handle.get());
    archive_read_support_format_tar(handle.get());
    if (archive_read_open_memory(handle.get(), package.data(), package.size()) != ARCHIVE_OK)
      return damaged(handle.get());
    archive_entry* entry = nullptr;
    for (;;) {
      const int found = archive_read_next_header(handle.get(), &entry);
      if (found == ARCHIVE_EOF) return {};
      // ARCHIVE_WARN means a minor fault, such as an unknown character in the name.
      if (found != ARCHIVE_OK && found != ARCHIVE_WARN) return damaged(handle.get());
      if (auto ok = unpack_entry(handle.get(), entry, prefix, depth); !ok) return ok;
    }
  }

  Expected<void> unpack_entry(archive* handle, archive_entry* entry, const std::string& prefix,
                              int depth) {
    if (++count_ > kMostPackedFiles)
      return refused(ErrorCode::kLimit, "has over " + std::to_string(kMostPackedFiles) +
                                            " files; pack only the model and its files");
    const std::string path = path_of(entry);
    if (auto ok = check_head(handle, entry, path); !ok) return ok;
    if (!is_plain_file(entry)) return {};
    PackedFile file{prefix.empty() ? path : prefix + '/' + path, {}};
    const bool is_whole = keeps_whole_(file.path);
    if (auto ok = read_contents(handle, is_whole, file.bytes); !ok) return ok;
    if (is_whole) return add(std::move(file), depth);
    files_.push_back(std::move(file));
    return {};
  }

  Expected<void> read_contents(archive* handle, bool is_whole, Bytes& out) {
    Bytes block(1 << 16);
    for (;;) {
      const la_ssize_t n = archive_read_data(handle, block.data(), block.size());
      if (n < 0) return damaged(handle);
      if (n == 0) return {};
      const auto count = static_cast<std::size_t>(n);
      if (count > left_)
        return refused(ErrorCode::kLimit, "unpacks to more than " + std::to_string(most_) +
                                              " bytes; pack only the model and its files");
      left_ -= count;
      const std::size_t kept = is_whole ? count : std::min(count, kHeadBytes - out.size());
      out.insert(out.end(), block.data(), block.data() + kept);
    }
  }

  // Adds a whole file, or the files in it if it is a package.
  Expected<void> add(PackedFile file, int depth) {
    if (is_package(file.bytes) && depth + 1 < kDeepest) {
      // counts the files inside the package instead of the package itself
      left_ += file.bytes.size();
      return unpack(file.bytes, file.path, depth + 1);
    }
    files_.push_back(std::move(file));
    return {};
  }

  std::uint64_t left_;
  const std::uint64_t most_;
  const std::function<bool(std::string_view)>& keeps_whole_;
  std::size_t count_ = 0;
  std::vector<PackedFile> files_;
};

}  // namespace

bool is_package(std::span<const std::uint8_t> bytes) {
  return is_zip(bytes) || is_tar(bytes) || is_gzip(bytes);
}

Expected<std::vector<PackedFile>> unpack(
    std::span<const std::uint8_t> package,
    const std::function<bool(std::string_view path)>& keeps_whole) {
  const std::uint64_t most =
      std::min<std::uint64_t>(kMostUnpackedBytes, package.size() * kMostUnpackedPerByte);
  Unpacker unpacker(most, keeps_whole);
  if (auto ok = unpacker.unpack(package, "", 0); !ok) return tl::unexpected(ok.error());
  return std::move(unpacker).files();
}

}  // namespace vitrine::inline codec
