// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/guardian.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "acquisition/device/controller.h"

extern char** environ;

namespace vitrine::acquisition {
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
  if (argc != 6)
    return fail(
        ErrorCode::kBadInput,
        "vitrine-guardian switches a scanner's laser and motor off if the program that drives "
        "the scanner dies. That program starts it; do not start it by hand");
  const auto dialect = parse_board_dialect(argv[1]);
  if (!dialect) return tl::unexpected(dialect.error());
  return BoardSelector{.dialect = *dialect,
                       .vendor = static_cast<std::uint16_t>(std::atoi(argv[2])),
                       .product = static_cast<std::uint16_t>(std::atoi(argv[3])),
                       .serial = argv[4],
                       .port = argv[5]};
}

Unexpected cannot_start(const std::string& program, const std::string& why) {
  return fail(ErrorCode::kIo,
              fmt::format("cannot start {}: {}; install it beside vitrine: without it, a laser may "
                          "stay on",
                          program, why));
}

// Starts the guardian program. Returns once the guardian has detached itself (see guard()).
Expected<void> spawn(std::vector<std::string> words, int input) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
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
  if (error != 0) return cannot_start(words[0], std::generic_category().message(error));
  int status = -1;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) return cannot_start(words[0], "it fails");
  return {};
}

// Retries for a while. The kernel may need a moment to release the board of a dead process, or the
// user may plug the board in again.
bool switch_off(const BoardSelector& selector) {
  constexpr int kAttempts = 20;
  std::string why;
  for (int i = 0; i < kAttempts; ++i) {
    const auto opened = open_controller(selector, std::chrono::seconds(1));
    if (opened) {
      if (!opened->controller->switch_off()) opened->controller->halt();
      return true;
    }
    why = opened.error().message;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  }
  fmt::print(stderr, "vitrine-guardian: {}\n", why);
  return false;
}

// Waits until the guarded process sends a dismissal or closes the socket. Returns true if a
// dismissal arrived.
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
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    return fail(
        ErrorCode::kIo,
        fmt::format(
            "cannot create a socket for the guardian process: {}; raise the limit of open files",
            std::generic_category().message(errno)));
  const auto path = program.empty() ? beside_this_program() : program;
  const auto started = spawn(words_for(selector, path.string()), ends[0]);
  ::close(ends[0]);
  if (started) return Guardian(ends[1]);
  ::close(ends[1]);
  return tl::unexpected(started.error());
}

Guardian::~Guardian() {
  if (socket_ >= 0) ::close(socket_);
}

bool Guardian::is_there() const {
  pollfd other_end{.fd = socket_, .events = 0, .revents = 0};
  return ::poll(&other_end, 1, 0) != 1;
}

void Guardian::dismiss() {
  if (socket_ < 0) return;
  if (::send(socket_, &kDismissed, 1, MSG_NOSIGNAL) == 1) {
    char end = 0;
    while (::recv(socket_, &end, 1, 0) < 0 && errno == EINTR) {
    }
  }
  ::close(std::exchange(socket_, -1));
}

int guard(int argc, char** argv) {
  const auto selector = selector_from(argc, argv);
  if (!selector) {
    fmt::print(stderr, "{}\n", selector.error().message);
    return 2;
  }
  // Detaches the guardian: the parent exits, so the guarded process need not reap the child.
  if (const pid_t child = ::fork(); child != 0) return child < 0 ? 1 : 0;
  ::setsid();  // signals of the terminal or the service must not reach the guardian
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE})
    ::signal(signal, SIG_IGN);
  return dismissed() || switch_off(*selector) ? 0 : 1;
}

}  // namespace vitrine::acquisition
