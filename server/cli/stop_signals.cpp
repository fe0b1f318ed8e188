// SPDX-License-Identifier: Apache-2.0
#include "server/cli/stop_signals.h"

#include <csignal>

namespace vitrine::cli {
namespace {

// Ctrl-C, a service manager, a closed terminal.
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t g_arrived = 0;

// A terminal that is closed sends SIGHUP by its shell and by itself.
void note(int signal) {
  g_arrived = 1;
  if (signal != SIGHUP) std::signal(signal, SIG_DFL);
}

// nohup has it ignored. So do shells with SIGINT of what runs in the background, which may be sent
// it all the same.
bool is_left_ignored(int signal) {
  struct sigaction now {};
  ::sigaction(signal, nullptr, &now);
  return signal == SIGHUP && now.sa_handler == SIG_IGN;
}

// Without SA_RESTART: a read from the terminal ends, too.
void handle(int signal, void (*handler)(int)) {
  if (is_left_ignored(signal)) return;
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  g_arrived = 0;
  for (const int signal : kSignals)
    handle(signal, note);
}

StopSignals::~StopSignals() {
  for (const int signal : kSignals)
    handle(signal, SIG_DFL);
}

bool StopSignals::arrived() {
  return g_arrived != 0;
}

}  // namespace vitrine::cli
