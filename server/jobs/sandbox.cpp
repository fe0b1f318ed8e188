// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/sandbox.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <malloc.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <initializer_list>
#include <memory>

#include "server/jobs/child_channel.h"

namespace vitrine {
namespace {

Unexpected refused(const char* what, int error) {
  return fail(ErrorCode::kIo, fmt::format("cannot {}: {}; a Linux kernel with seccomp is needed",
                                          what, std::strerror(error)));
}

// Enough to compute with several threads, to read what is open and to answer.
constexpr int kAllowed[] = {SCMP_SYS(read),
                            SCMP_SYS(pread64),
                            SCMP_SYS(write),
                            SCMP_SYS(writev),
                            SCMP_SYS(close),
                            SCMP_SYS(lseek),
                            SCMP_SYS(fstat),
                            SCMP_SYS(brk),
                            SCMP_SYS(munmap),
                            SCMP_SYS(mremap),
                            SCMP_SYS(madvise),
                            SCMP_SYS(futex),
                            SCMP_SYS(rt_sigaction),
                            SCMP_SYS(rt_sigprocmask),
                            SCMP_SYS(rt_sigreturn),
                            SCMP_SYS(sigaltstack),
                            SCMP_SYS(clock_gettime),
                            SCMP_SYS(gettimeofday),
                            SCMP_SYS(getrusage),
                            SCMP_SYS(getpid),
                            SCMP_SYS(gettid),
                            SCMP_SYS(sched_yield),
                            SCMP_SYS(getrandom),
                            SCMP_SYS(sched_getaffinity),
                            SCMP_SYS(exit),
                            SCMP_SYS(exit_group),
                            SCMP_SYS(set_robust_list),
                            SCMP_SYS(rseq),
                            SCMP_SYS(nanosleep),
                            SCMP_SYS(clock_nanosleep),
                            SCMP_SYS(restart_syscall)};

// What libraries try in passing and can do without fails as if it were forbidden to this user.
constexpr int kDenied[] = {SCMP_SYS(open),       SCMP_SYS(openat),     SCMP_SYS(openat2),
                           SCMP_SYS(newfstatat), SCMP_SYS(stat),       SCMP_SYS(access),
                           SCMP_SYS(faccessat),  SCMP_SYS(faccessat2), SCMP_SYS(readlink),
                           SCMP_SYS(readlinkat), SCMP_SYS(prlimit64),  SCMP_SYS(ioctl),
                           SCMP_SYS(prctl),      SCMP_SYS(sysinfo),    SCMP_SYS(statx)};

using Filter = std::unique_ptr<void, decltype(&seccomp_release)>;

// Adds rules until one fails; returns 0 or the error number.
class Rules {
 public:
  explicit Rules(const Filter& filter) : filter_(filter.get()) {}

  void allow(int call) { keep(seccomp_rule_add(filter_, SCMP_ACT_ALLOW, call, 0)); }
  void allow_if(int call, const scmp_arg_cmp& condition) {
    keep(seccomp_rule_add_array(filter_, SCMP_ACT_ALLOW, call, 1, &condition));
  }
  void deny(int call, int error) {
    keep(seccomp_rule_add(filter_, SCMP_ACT_ERRNO(static_cast<std::uint32_t>(error)), call, 0));
  }
  int load() {
    if (result_ == 0) result_ = seccomp_load(filter_);
    return -result_;
  }

 private:
  void keep(int result) {
    if (result_ == 0) result_ = result;
  }
  scmp_filter_ctx filter_;
  int result_ = 0;
};

// The library's own macros for this are C only.
scmp_arg_cmp argument(unsigned index, scmp_compare how, scmp_datum_t a, scmp_datum_t b = 0) {
  return {index, how, a, b};
}

Expected<void> install_filter() {
  // Anything not listed ends the process: sockets, programs, processes, ptrace.
  const Filter filter(seccomp_init(SCMP_ACT_KILL_PROCESS), seccomp_release);
  if (!filter) return refused("create a system call filter", ENOMEM);
  Rules rules(filter);
  for (const int call : kAllowed)
    rules.allow(call);
  for (const int call : kDenied)
    rules.deny(call, EACCES);
  // Memory is never both data and code, and threads are not processes.
  rules.allow_if(SCMP_SYS(mmap), argument(2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  rules.allow_if(SCMP_SYS(mprotect), argument(2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  rules.allow_if(SCMP_SYS(clone), argument(0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
  rules.deny(SCMP_SYS(clone3), ENOSYS);  // its flags are out of a filter's sight; libc uses clone
  rules.allow_if(SCMP_SYS(tgkill), argument(0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(::getpid())));
  if (const int error = rules.load(); error != 0)
    return refused("install a system call filter", error);
  return {};
}

// Blocks from this size on go back to the system as soon as they are freed. glibc by itself raises
// the size with use, after which freed memory stays scattered: a seventh more at the peak.
constexpr int kLargeBlock = 1 << 20;

int set_limit(int which, rlim_t soft, rlim_t hard) {
  const rlimit limit{soft, hard};
  return ::setrlimit(static_cast<__rlimit_resource_t>(which), &limit) == 0 ? 0 : errno;
}

// A sanitizer reserves terabytes of address space for its shadow.
#ifdef VITRINE_SANITISED
constexpr bool kLimitMemory = false;
#else
constexpr bool kLimitMemory = true;
#endif

Expected<void> set_limits(const SandboxLimits& limits) {
  int error = 0;
  const auto limit = [&](int which, rlim_t value, rlim_t grace = 0) {
    if (error == 0) error = set_limit(which, value, value + grace);
  };
  if (kLimitMemory) limit(RLIMIT_AS, limits.memory_bytes + spill_capacity());
  limit(RLIMIT_CPU, limits.cpu_seconds, 1);  // SIGXCPU says why, SIGKILL comes a second later
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_NOFILE, 0);  // nothing new; what is open stays
  if (error != 0) return refused("limit a child process", error);
  return {};
}

// Standard streams lead nowhere, and of all other descriptors only `kept` is left.
void close_all_but(int kept) {
  const int nowhere = ::open("/dev/null", O_RDWR);
  for (int fd = 0; fd <= 2; ++fd)
    ::dup2(nowhere, fd);
  ::close_range(3, static_cast<unsigned>(kept) - 1, 0);
  ::close_range(static_cast<unsigned>(kept) + 1, ~0u, 0);
}

}  // namespace

Expected<void> confine(const SandboxLimits& limits) {
  ::mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  if (auto limited = set_limits(limits); !limited) return limited;
  if (::prctl(PR_SET_DUMPABLE, 0) != 0 || ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    return refused("drop privileges", errno);
  }
  return install_filter();
}

Expected<std::vector<std::uint8_t>> run_sandboxed(const SandboxLimits& limits,
                                                  const SandboxedTask& task,
                                                  const ProgressReport& progress) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return refused("make a pipe", errno);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent died before the line above
    close_all_but(ends[1]);
    answer_and_exit(ends[1], limits, task);
  }
  const int error = errno;
  ::close(ends[1]);
  auto answer = child < 0 ? Expected<std::vector<std::uint8_t>>(refused("start a process", error))
                          : await_answer(child, ends[0], limits, progress);
  ::close(ends[0]);
  return answer;
}

}  // namespace vitrine
