// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/guardian.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "acquisition/device/controller.h"

extern char** environ;

namespace vitrine {
namespace {

constexpr char kDismissed = 'd';

std::vector<std::string> words_for(const BoardSelector& selector, const std::string& program) {
  return {program,
          name_of(selector.dialect),
          std::to_string(selector.vendor),
          std::to_string(selector.product),
          selector.serial,
          selector.port};
}

Expected<BoardSelector> selector_from(int argc, char** argv) {
  if (argc != 6) return fail(ErrorCode::kBadInput, "vitrine-guardian is started by vitrine alone");
  const auto dialect = parse_board_dialect(argv[1]);
  if (!dialect) return Unexpected(dialect.error());
  return BoardSelector{.dialect = *dialect,
                       .vendor = static_cast<std::uint16_t>(std::atoi(argv[2])),
                       .product = static_cast<std::uint16_t>(std::atoi(argv[3])),
                       .serial = argv[4],
                       .port = argv[5]};
}

Expected<pid_t> spawn(std::vector<std::string> words, int input) {
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  pid_t process = -1;
  const int error =
      posix_spawn(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    return fail(ErrorCode::kIo,
                fmt::format("cannot start {}: {}; install it beside vitrine, lasers are not safe "
                            "without it",
                            words[0], std::generic_category().message(error)));
  return process;
}

bool switch_off(const BoardSelector& selector) {
  const auto opened = open_controller(selector, std::chrono::seconds(1));
  if (!opened) return false;
  if (!opened->controller->switch_off()) opened->controller->halt();
  return true;
}

// Whether the other end said so before it closed.
bool dismissed() {
  char byte = 0;
  ssize_t count = 0;
  do {
    count = ::read(STDIN_FILENO, &byte, 1);
  } while (count < 0 && errno == EINTR);
  return count == 1 && byte == kDismissed;
}

std::filesystem::path beside_this_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "vitrine-guardian";
}

}  // namespace

Expected<Guardian> Guardian::start(const BoardSelector& selector,
                                   const std::filesystem::path& program) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0)
    return fail(ErrorCode::kIo, fmt::format("no pipe to a guardian process: {}; raise the limit of "
                                            "open files",
                                            std::generic_category().message(errno)));
  const auto path = program.empty() ? beside_this_program() : program;
  const auto process = spawn(words_for(selector, path.string()), ends[0]);
  ::close(ends[0]);
  if (process) return Guardian(ends[1], *process);
  ::close(ends[1]);
  return Unexpected(process.error());
}

void Guardian::dismiss() {
  if (pipe_ < 0) return;
  // MSG_NOSIGNAL has no like for pipes: where the guardian is dead already, nothing is written.
  if (::waitpid(process_, nullptr, WNOHANG) == 0) {
    [[maybe_unused]] const ssize_t written = ::write(pipe_, &kDismissed, 1);
    ::close(pipe_);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  } else {
    ::close(pipe_);
  }
  pipe_ = -1;
}

int guard(int argc, char** argv) {
  ::setsid();  // the terminal's and the service's signals are meant for the process guarded
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE})
    ::signal(signal, SIG_IGN);
  const auto selector = selector_from(argc, argv);
  if (!selector) {
    fmt::print(stderr, "{}\n", selector.error().message);
    return 2;
  }
  return dismissed() || switch_off(*selector) ? 0 : 1;
}

}  // namespace vitrine
