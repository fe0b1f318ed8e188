// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/build_child.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <optional>
#include <string>

#include "codec/build/build_model.h"
#include "codec/build/verify_model.h"
#include "codec/core/bounded_lines.h"
#include "codec/core/printable.h"
#include "codec/format/signature.h"
#include "server/sandbox/child_channel.h"

// glibc 2.36 declares the functions for pidfds only for C, so this file calls syscall().
namespace vitrine::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The child's arguments are: --build-child PARENT BITS PLACEMENT UP UNIT FOLDER RESERVE NAME. The
// child reads the mesh from standard input and writes the result to standard output.
constexpr std::string_view kChild = "--build-child";
constexpr std::size_t kArguments = 9;

Unexpected refused(const char* what) {
  return fail(ErrorCode::kIo, fmt::format("cannot {}: {}; free some memory and try again", what,
                                          std::strerror(errno)));
}

// Largest size of the spill file in bytes. It prevents one build from filling the disk, which may
// also contain models and uploads. The size suffices for 70 million triangles. A larger mesh can be
// built elsewhere, and its .pmesh file uploaded.
constexpr std::uint64_t kMostSpilled = 16ull << 30;
constexpr std::size_t kMostRepairs = 4096;  // largest size in bytes of ChildResult::repairs

SandboxLimits limits_of(const std::filesystem::path& folder, std::uint64_t disk_reserve) {
  return {.spill = {.folder = folder, .max_bytes = kMostSpilled, .disk_reserve = disk_reserve}};
}

// Returns an unnamed file in memory with these bytes, which the child can map.
Expected<FileDescriptor> hand_over(std::span<const std::uint8_t> bytes) {
  FileDescriptor file(::memfd_create("mesh", MFD_CLOEXEC));
  if (!file) return refused("keep the mesh in memory");
  while (!bytes.empty()) {
    const ssize_t n = ::write(file.get(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return refused("keep the mesh in memory");
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return file;
}

struct Pipe {
  FileDescriptor read, write;
};

Expected<Pipe> make_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return refused("make a pipe");
  return Pipe{FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

// Starts the child with `mesh` and `answer` as standard input and output, and returns its PID. The
// child gets no environment, because the environment may contain secrets.
Expected<pid_t> start(const BuildOrder& order, int mesh, int answer) {
  const std::array<std::string, kArguments> texts = {
      std::string(kChild),
      std::to_string(::getpid()),
      std::to_string(order.bits),
      std::to_string(static_cast<int>(order.placement)),
      std::to_string(order.z_is_up ? 1 : 0),
      order.unit,
      order.folder.string(),
      std::to_string(order.disk_reserve),
      order.name};
  std::string name = "vitrine-build";
  std::vector<char*> arguments = {name.data()};
  for (const std::string& text : texts)
    arguments.push_back(const_cast<char*>(text.c_str()));
  arguments.push_back(nullptr);
  char* no_environment[] = {nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, mesh, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, answer, STDOUT_FILENO);
  pid_t pid = -1;
  errno = ::posix_spawn(&pid, order.program.c_str(), &actions, nullptr, arguments.data(),
                        no_environment);
  ::posix_spawn_file_actions_destroy(&actions);
  if (errno != 0) return refused("start a process");
  return pid;
}

std::string printable_lines(std::string_view text) {
  std::string out;
  for (;;) {
    const std::size_t end = text.find('\n');
    out += printable_text(text.substr(0, end));
    if (end == text.npos) return out;
    out += '\n';
    text.remove_prefix(end + 1);
  }
}

// Splits the child's answer into the file and the repairs.
Expected<ChildResult> separate(Bytes answer) {
  const auto damaged = [] {
    return fail(ErrorCode::kBadInput, "the build ended without a result; export the mesh again");
  };
  if (answer.size() < 4) return damaged();
  std::size_t length = 0;
  for (std::size_t i = 4; i > 0; --i)
    length = length << 8 | answer[answer.size() - 5 + i];
  answer.erase(answer.end() - 4, answer.end());
  if (length > kMostRepairs || length > answer.size()) return damaged();
  ChildResult result;
  const auto begin = answer.end() - static_cast<std::ptrdiff_t>(length);
  result.repairs.assign(begin, answer.end());
  answer.erase(begin, answer.end());
  result.repairs = printable_lines(result.repairs);
  result.file = std::move(answer);
  return result;
}

// The functions from here to the end of the namespace run in the child.

template <class Number = int>
Number number(std::string_view text) {
  Number value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// Returns the mesh, mapped into memory, or nullopt if the address space has no room for it.
std::optional<std::span<const std::uint8_t>> map_input() {
  using Mesh = std::span<const std::uint8_t>;
  struct stat status {};
  if (::fstat(STDIN_FILENO, &status) != 0 || status.st_size <= 0) return Mesh{};
  const auto size = static_cast<std::size_t>(status.st_size);
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
  if (data == MAP_FAILED) return errno == ENOMEM ? std::nullopt : std::optional(Mesh{});
  return Mesh(static_cast<const std::uint8_t*>(data), size);
}

// Closes the parent's descriptors. Standard error becomes /dev/null, so that the child cannot write
// to the operator's terminal.
void close_the_rest() {
  const int nowhere = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  ::dup2(nowhere, STDERR_FILENO);
  ::close_range(STDERR_FILENO + 1, ~0u, 0);
}

// Appends the lines to the file, and then the length of the lines in four bytes. separate() reads
// this form.
Bytes with_repairs(Bytes file, const std::vector<std::string>& lines) {
  const std::string text = bounded_lines(lines, kMostRepairs);
  file.insert(file.end(), text.begin(), text.end());
  for (int shift = 0; shift < 32; shift += 8)
    file.push_back(static_cast<std::uint8_t>(text.size() >> shift));
  return file;
}

Expected<Bytes> verify(std::span<const std::uint8_t> pmesh, const ProgressReport& progress) {
  const auto verified = verify_model(pmesh, std::nullopt, progress);
  if (!verified) return tl::unexpected(verified.error());
  return with_repairs({}, {});
}

}  // namespace

void become_build_child(std::span<const std::string_view> arguments) {
  if (arguments.size() != kArguments || arguments[0] != kChild) return;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // the parent may have died before the call of prctl()
  if (::getppid() != number(arguments[1])) ::_exit(1);
  std::signal(SIGPIPE, SIG_DFL);
  close_the_rest();
  const auto mesh = map_input();
  const BuildOptions options{.reading = {.unit = arguments[5],
                                         .up = arguments[4] == "1" ? UpAxis::kZ : UpAxis::kY,
                                         .name = arguments[8]},
                             .bits = number(arguments[2]),
                             .placement = static_cast<Placement>(number(arguments[3]))};
  answer_and_exit(STDOUT_FILENO, limits_of(arguments[6], number<std::uint64_t>(arguments[7])),
                  [&](const ProgressReport& progress) -> Expected<Bytes> {
                    if (!mesh) exit_without_memory();
                    if (is_pmesh(*mesh)) return verify(*mesh, progress);
                    auto built = build_model(*mesh, options, progress);
                    if (!built) return tl::unexpected(built.error());
                    return with_repairs(std::move(built->file), built->report.input.repairs);
                  });
}

void BuildChild::watch(int pid) {
  const std::scoped_lock lock(mutex_);
  child_ = FileDescriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
  // The PID cannot belong to another process: the parent has not yet called wait() for the child.
  if (is_stopped_) ::kill(pid, SIGKILL);
}

void BuildChild::stop() noexcept {
  const std::scoped_lock lock(mutex_);
  is_stopped_ = true;
  if (child_) ::syscall(SYS_pidfd_send_signal, child_.get(), SIGKILL, nullptr, 0);
}

Expected<ChildResult> BuildChild::build(std::span<const std::uint8_t> mesh, const BuildOrder& order,
                                        const ProgressReport& progress) {
  const auto input = hand_over(mesh);
  if (!input) return tl::unexpected(input.error());
  return build(*input, order, progress);
}

Expected<ChildResult> BuildChild::build(const FileDescriptor& mesh, const BuildOrder& order,
                                        const ProgressReport& progress) {
  auto pipe = make_pipe();
  if (!pipe) return tl::unexpected(pipe.error());
  const auto pid = start(order, mesh.get(), pipe->write.get());
  if (!pid) return tl::unexpected(pid.error());
  pipe->write.reset();
  watch(*pid);
  const SandboxLimits limits = limits_of(order.folder, order.disk_reserve);
  auto answer = await_answer(*pid, pipe->read.get(), limits, progress);
  const std::scoped_lock lock(mutex_);
  child_.reset();
  if (!answer && is_stopped_)
    return fail(ErrorCode::kState, "the build was stopped; start it again");
  if (!answer) return tl::unexpected(answer.error());
  return separate(std::move(*answer));
}

}  // namespace vitrine::server
