// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/spill.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <thread>

#include "codec/files/file_descriptor.h"
#include "server/sandbox/page_ranges.h"
#include "server/sandbox/spare_memory.h"

namespace vitrine::server {
namespace {

// Blocks of at least this many bytes may spill. Class Segments (codec/core/segments.h) allocates
// blocks of this size.
constexpr std::size_t kLarge = 8192;
// The disk space of a freed range is released if the range has at least this many bytes.
constexpr std::size_t kWorthHole = 1 << 20;
constexpr std::size_t kLargestPage = 65'536;  // largest page size of any supported kernel
// Blocks spill once large blocks in memory take 1 / kHeldShare of SpillOptions::resident_bytes.
constexpr std::uint64_t kHeldShare = 4;
// trim() unmaps pages once the process uses this share of SpillOptions::resident_bytes. The
// remaining memory is for pages that are loaded before the next check.
constexpr double kTrimShare = 0.625;
constexpr std::uint64_t kFew = 8;
constexpr auto kLook = std::chrono::milliseconds(1);
constexpr std::size_t kLargePage = 2 << 20;

// The spill file and its blocks. A process has at most one Spill, which is never destroyed.
class Spill {
 public:
  Spill(const SpillOptions& options, std::byte* base, std::size_t capacity, int statm)
      : base_(base),
        capacity_(capacity),
        statm_(statm),
        most_held_(static_cast<std::int64_t>(options.resident_bytes / kHeldShare)),
        most_resident_(
            static_cast<std::uint64_t>(kTrimShare * static_cast<double>(options.resident_bytes))),
        input_(options.input),
        ranges_(capacity) {}

  std::size_t capacity() const { return capacity_; }
  bool owns(const void* p) const {
    return p >= static_cast<const void*>(base_) && p < static_cast<const void*>(base_ + capacity_);
  }

  bool is_full(std::size_t size) const {
    return held_ + static_cast<std::int64_t>(size) > most_held_;
  }
  void hold(void* p) {
    if (const std::size_t size = ::malloc_usable_size(p); size >= kLarge)
      held_ += static_cast<std::int64_t>(size);
  }
  void let_go(void* p) {
    if (const std::size_t size = ::malloc_usable_size(p); size >= kLarge)
      held_ -= static_cast<std::int64_t>(size);
  }

  void* take(std::size_t size) {
    const std::lock_guard lock(mutex_);
    const auto offset = ranges_.take(size);
    return offset ? base_ + *offset : nullptr;
  }

  void give_back(void* p) {
    const std::lock_guard lock(mutex_);
    const auto begin = static_cast<std::size_t>(static_cast<std::byte*>(p) - base_);
    const std::size_t size = ranges_.give_back(begin);
    if (size >= kWorthHole) punch_hole(begin, begin + size);
  }

  std::size_t spilled() {
    const std::lock_guard lock(mutex_);
    return ranges_.taken();
  }

  // Unmaps the pages of mapped files if the process uses too much memory. The pages keep their
  // content, because the kernel caches or writes them. Pages in use are soon loaded again, so
  // unmapping is worthwhile only if it frees much memory.
  void trim() {
    const auto [all, mapped] = resident();
    if (all <= most_resident_ || mapped <= most_resident_ / kFew) return;
    ::madvise(base_, used(), MADV_DONTNEED);
    drop_input();
  }

  struct Resident {
    std::uint64_t all = 0, mapped = 0;  // resident bytes: total, and those of mapped files
  };
  Resident resident() const {
    std::array<char, 128> text{};
    if (::pread(statm_, text.data(), text.size() - 1, 0) <= 0) return {};
    char* at = text.data();
    std::strtoull(at, &at, 10);  // skips the size of the address space
    const std::uint64_t all = std::strtoull(at, &at, 10), mapped = std::strtoull(at, &at, 10);
    const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return {all * page, mapped * page};
  }

 private:
  std::size_t used() {
    const std::lock_guard lock(mutex_);
    return ranges_.end();
  }

  // Releases the disk space of the whole pages between `begin` and `end`.
  void punch_hole(std::size_t begin, std::size_t end) const {
    const std::size_t first = (begin + kLargestPage - 1) / kLargestPage * kLargestPage;
    const std::size_t last = end / kLargestPage * kLargestPage;
    ::madvise(base_ + first, last - first, MADV_REMOVE);
  }

  void drop_input() const {
    ::madvise(const_cast<std::uint8_t*>(input_.data()), input_.size(), MADV_DONTNEED);
  }

  std::byte* base_;
  std::size_t capacity_;
  int statm_;
  std::int64_t most_held_;
  std::uint64_t most_resident_;
  std::span<const std::uint8_t> input_;
  // Total bytes of those large blocks in memory that were allocated after the spill file was
  // opened.
  std::atomic<std::int64_t> held_ = 0;
  std::mutex mutex_;
  PageRanges ranges_;
};

std::atomic<Spill*> spill = nullptr;

Unexpected refused(const std::filesystem::path& folder, int error) {
  return fail(
      ErrorCode::kIo,
      fmt::format("cannot make a working file in {}: {}; choose a folder on a disk with room",
                  folder.string(), std::strerror(error)));
}

// Creates a file without a name. If the file system cannot do this, creates a file and removes its
// name at once.
FileDescriptor nameless_file(const std::filesystem::path& folder) {
  FileDescriptor fd(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (fd) return fd;
  std::string name = (folder / ".vitrine.XXXXXX").string();
  fd = FileDescriptor(::mkostemp(name.data(), O_CLOEXEC));
  if (fd) ::unlink(name.c_str());
  return fd;
}

std::size_t capacity_on(const struct statvfs& disk, const SpillOptions& options) {
  struct rlimit file {};
  std::uint64_t most = options.max_bytes;
  if (::getrlimit(RLIMIT_FSIZE, &file) == 0) most = std::min<std::uint64_t>(most, file.rlim_cur);
  const std::uint64_t room = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  most = std::min(most, (room - std::min(room, options.disk_reserve)) / 2);
  return most / PageRanges::kPage * PageRanges::kPage;
}

}  // namespace

Expected<void> open_spill(const SpillOptions& options) {
  if (options.folder.empty()) return {};
  const FileDescriptor file = nameless_file(options.folder);
  struct statvfs disk {};
  if (!file || ::fstatvfs(file.get(), &disk) != 0) return refused(options.folder, errno);
  const std::size_t capacity = capacity_on(disk, options);
  if (capacity == 0 || ::ftruncate(file.get(), static_cast<off_t>(capacity)) != 0) return {};
  void* base = ::mmap(nullptr, capacity, PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
  if (base == MAP_FAILED) return {};
  // This descriptor stays open until the process ends.
  const int statm = ::open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (statm < 0) return refused("/proc", errno);
  spill = new Spill(options, static_cast<std::byte*>(base), capacity, statm);
  return {};
}

void start_trimming() {
  if (spill == nullptr) return;
  std::thread([] {
    for (;;) {
      spill.load()->trim();
      std::this_thread::sleep_for(kLook);
    }
  }).detach();
}

std::uint64_t spill_capacity() {
  return spill != nullptr ? spill.load()->capacity() : 0;
}

std::uint64_t mapped_bytes() {
  return spill != nullptr ? spill.load()->resident().mapped : 0;
}

std::uint64_t spilled_bytes() {
  return spill != nullptr ? spill.load()->spilled() : 0;
}

namespace {

constinit SpareMemory spare;

// Allocates in memory. A build accesses arrays of megabytes at random positions. Huge pages, which
// the kernel grants if it can, save a tenth of the build's time in page faults and TLB misses.
void* take_in_memory(std::size_t size) noexcept {
  if (size < 2 * kLargePage) return std::malloc(std::max<std::size_t>(size, 1));
  void* p = nullptr;
  if (::posix_memalign(&p, kLargePage, size) != 0) return nullptr;
  ::madvise(p, size / kLargePage * kLargePage, MADV_HUGEPAGE);
  return p;
}

void* take(std::size_t size) noexcept {
  Spill* const here = spill;
  const bool is_large = here != nullptr && size >= kLarge;
  if (is_large && here->is_full(size)) {
    if (void* p = here->take(size)) return p;
  }
  void* p = take_in_memory(size);
  if (p == nullptr) return spare.take(size);
  if (here != nullptr) here->hold(p);
  return p;
}

void* take_or_throw(std::size_t size) {
  for (;;) {
    if (void* p = take(size)) return p;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void give_back(void* p) noexcept {
  if (spare.give_back(p)) return;
  Spill* const here = spill;
  if (here != nullptr && here->owns(p)) return here->give_back(p);
  if (here != nullptr && p != nullptr) here->let_go(p);
  std::free(p);
}

}  // namespace
}  // namespace vitrine::server

// Replaces all forms of operator new and delete except those with an alignment argument, whose
// blocks stay in memory. Defines every form separately, because the sanitizers' own forms do not
// call each other.
void* operator new(std::size_t size) {
  return vitrine::server::take_or_throw(size);
}
void* operator new[](std::size_t size) {
  return vitrine::server::take_or_throw(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return vitrine::server::take(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return vitrine::server::take(size);
}
void operator delete(void* p) noexcept {
  vitrine::server::give_back(p);
}
void operator delete[](void* p) noexcept {
  vitrine::server::give_back(p);
}
void operator delete(void* p, std::size_t) noexcept {
  vitrine::server::give_back(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  vitrine::server::give_back(p);
}
void operator delete(void* p, const std::nothrow_t&) noexcept {
  vitrine::server::give_back(p);
}
void operator delete[](void* p, const std::nothrow_t&) noexcept {
  vitrine::server::give_back(p);
}
