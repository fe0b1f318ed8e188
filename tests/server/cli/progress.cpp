// SPDX-License-Identifier: Apache-2.0
// What people see of a build while it runs, and what is left of one that they stop.
#include <gmock/gmock.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <limits>
#include <regex>
#include <string>
#include <vector>

#include "server/cli/console.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// A program on a terminal.
class OnTerminal {
 public:
  explicit OnTerminal(std::vector<std::string> words) {
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words)
      arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ == 0) {
      ::execv(arguments[0], arguments.data());
      ::_exit(127);
    }
  }
  ~OnTerminal() { ::close(terminal_); }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  // Reads until `text` has come so many times, or to the end.
  void wait_for(const std::string& text, int times = 1) {
    while (count(text) < times && read_some()) {
    }
  }
  void signal(int number) const { ::kill(pid_, number); }
  // To the process that does the work.
  void signal_child(int number) const {
    const std::string pid = std::to_string(pid_);
    std::ifstream children("/proc/" + pid + "/task/" + pid + "/children");
    pid_t child = 0;
    ASSERT_TRUE(children >> child);
    ::kill(child, number);
  }
  // Reads to the end; the status as of waitpid().
  int finish() {
    while (read_some()) {
    }
    int status = 0;
    ::waitpid(pid_, &status, 0);
    return status;
  }
  const std::string& seen() const { return seen_; }

 private:
  int count(const std::string& text) const {
    int found = 0;
    for (std::size_t at = 0; (at = seen_.find(text, at)) != std::string::npos; at += text.size())
      ++found;
    return found;
  }

  bool read_some() {
    std::array<char, 4096> part{};
    ssize_t n = 0;
    do {
      n = ::read(terminal_, part.data(), part.size());
    } while (n < 0 && errno == EINTR);
    if (n > 0) seen_.append(part.data(), static_cast<std::size_t>(n));
    return n > 0;
  }

  int terminal_ = -1;
  pid_t pid_ = -1;
  std::string seen_;
};

// All shares that a terminal was shown, in their order.
std::vector<int> shares_in(const std::string& seen) {
  static const std::regex share("([0-9]+) % ");
  std::vector<int> shares;
  for (auto at = std::sregex_iterator(seen.begin(), seen.end(), share);
       at != std::sregex_iterator(); ++at)
    shares.push_back(std::stoi((*at)[1]));
  return shares;
}

TEST(TimeLeft, is_what_the_rest_takes_at_the_pace_so_far) {
  EXPECT_EQ(cli::time_left(10, 0.2, 0), "about 40 s left");
  EXPECT_EQ(cli::time_left(60, 0.1, 0), "about 9 min left");
  EXPECT_EQ(cli::time_left(3'600, 0.1, 0), "about 9 h left");
  EXPECT_EQ(cli::time_left(0.001, 0.5, 0), "about 1 s left");
}

TEST(TimeLeft, runs_down_and_never_out) {
  EXPECT_EQ(cli::time_left(10, 0.2, 15), "about 25 s left");
  EXPECT_EQ(cli::time_left(10, 0.2, 1'000), "about 1 s left");
}

TEST(TimeLeft, is_not_told_before_something_and_after_all_is_done) {
  for (const double fraction : {-1.0, 0.0, 0.001, 1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(cli::time_left(10, fraction, 0), "") << fraction;
}

TEST_F(VitrineCommand, a_terminal_shows_how_far_a_build_is_and_the_time_left) {
  const std::string in = write("in.ply", bumpy_ply(3'000));
  OnTerminal build({kVitrine, "build", in, "-o", path("out.pmesh")});
  EXPECT_EQ(build.finish(), 0);
  EXPECT_THAT(build.seen(), HasSubstr(" s left"));
  EXPECT_THAT(build.seen(), HasSubstr(" % simplify"));
  EXPECT_THAT(build.seen(), HasSubstr(" % encode"));
}

TEST_F(VitrineCommand, the_bar_of_a_build_with_a_report_never_goes_back) {
  const std::string in = write("in.ply", bumpy_ply(3'000));
  OnTerminal build({kVitrine, "build", in, "-o", path("out.pmesh"), "--report", path("out.html")});
  EXPECT_EQ(build.finish(), 0);
  EXPECT_THAT(build.seen(), HasSubstr(" % report"));
  const std::vector<int> shares = shares_in(build.seen());
  EXPECT_TRUE(std::ranges::is_sorted(shares)) << build.seen();
}

TEST_F(VitrineCommand, the_bar_is_drawn_anew_while_a_build_has_nothing_to_report) {
  const std::string in = write("in.ply", bumpy_ply(130'000));
  OnTerminal build({kVitrine, "build", in, "-o", path("out.pmesh")});
  build.wait_for(" % read");  // the first bar, long before the next
  build.signal_child(SIGSTOP);
  build.wait_for(" left", 3);
  build.signal_child(SIGCONT);
  EXPECT_EQ(build.finish(), 0);
}

TEST_F(VitrineCommand, an_interrupted_build_leaves_nothing_and_can_be_started_again) {
  const std::string in = write("in.ply", bumpy_ply(130'000));
  for (const int number : {SIGINT, SIGTERM, SIGKILL}) {
    OnTerminal build({kVitrine, "build", in, "-o", path("out.pmesh")});
    build.wait_for(" % simplify");
    build.signal(number);
    const int status = build.finish();
    ASSERT_TRUE(WIFSIGNALED(status)) << build.seen();
    EXPECT_EQ(WTERMSIG(status), number);
    EXPECT_THAT(files(), ElementsAre("in.ply"));
  }
  vitrine_json({"build", in, "-o", path("out.pmesh")});
  EXPECT_EQ(vitrine_json({"verify", path("out.pmesh"), "--against", in})["lossless"], true);
}

TEST_F(VitrineCommand, an_interrupted_build_leaves_an_older_output_as_it_was) {
  const std::string in = write("in.ply", bumpy_ply(130'000)), out = write("out.pmesh", "precious");
  OnTerminal build({kVitrine, "build", in, "-o", out});
  build.wait_for(" % encode");
  build.signal(SIGTERM);
  EXPECT_TRUE(WIFSIGNALED(build.finish()));
  EXPECT_EQ(read("out.pmesh"), "precious");
  EXPECT_THAT(files(), ElementsAre("in.ply", "out.pmesh"));
}

}  // namespace
}  // namespace vitrine::test
