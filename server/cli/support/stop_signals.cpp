// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/stop_signals.h"

#include <csignal>

namespace vitrine::server::cli {
namespace {

// Signals sent by Ctrl-C, by a service manager, and when a terminal is closed.
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t g_arrived = 0;

// Records the signal. A second SIGINT or SIGTERM then kills the process. A second SIGHUP must not:
// when a terminal is closed, the terminal and its shell both send SIGHUP.
void note(int signal) {
  g_arrived = 1;
  if (signal != SIGHUP) std::signal(signal, SIG_DFL);
}

// Whether to leave a signal ignored. Returns true for SIGHUP if nohup has made the process ignore
// it. Returns false for SIGINT, which shells make background commands ignore, because a user may
// send it on purpose.
bool is_left_ignored(int signal) {
  struct sigaction now {};
  ::sigaction(signal, nullptr, &now);
  return signal == SIGHUP && now.sa_handler == SIG_IGN;
}

// Installs a handler. Without SA_RESTART, the signal also interrupts a read from the terminal.
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

}  // namespace vitrine::server::cli
