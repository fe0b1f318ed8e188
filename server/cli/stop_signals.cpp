// SPDX-License-Identifier: Apache-2.0
#include "server/cli/stop_signals.h"

#include <csignal>

namespace vitrine::cli {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM,
                            SIGHUP};  // Ctrl-C, a service manager, a closed terminal

volatile std::sig_atomic_t g_arrived = 0;

void note(int signal) {
  g_arrived = 1;
  std::signal(signal, SIG_DFL);
}

// Without SA_RESTART: a read from the terminal ends, too. What nohup and the like ignore stays so.
void handle(int signal, void (*handler)(int)) {
  struct sigaction action {
  }, before{};
  ::sigaction(signal, nullptr, &before);
  if (before.sa_handler == SIG_IGN) return;
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
