// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_board/usb_board.h"

#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include "acquisition/rig_board/bus_users.h"

namespace vitrine::acquisition::rig {
namespace {

using Clock = std::chrono::steady_clock;

// Seconds by which the answer "no transfer is finished yet" is delayed. libusb asks for finished
// transfers as long as the device file is writable. The simulated file is a socket and therefore
// always writable, so without the delay libusb would poll in a tight loop.
constexpr double kHold = 0.0015;
// Interval in seconds at which FTDI chips send their status even if they have no data.
constexpr double kFtdiIdle = 0.016;
constexpr std::size_t kMostUnread = 4096;
// How long the destructor waits for guardian processes. They give up sooner than this.
constexpr std::chrono::seconds kGuardians(15);

constexpr char kPath[] = "/sys/devices/pci0000:00/0000:00:14.0/usb1/1-2";
constexpr char kPreload[] = "libumockdev-preload.so.0";
constexpr char kNode[] = "/dev/bus/usb/001/002";

struct UmockdevUnref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class T>
using UmockdevRef = std::unique_ptr<T, UmockdevUnref>;

template <class T>
UmockdevRef<T> share(T* object) {
  return UmockdevRef<T>(static_cast<T*>(g_object_ref(object)));
}

// A transfer that a client has submitted. umockdev copies the kernel's struct and its buffer, and
// writes the copies back when the client fetches the finished transfer.
struct UsbTransfer {
  UmockdevRef<UMockdevIoctlData> block, buffer;

  usbdevfs_urb& urb() const { return *reinterpret_cast<usbdevfs_urb*>(block->data); }
  std::span<std::uint8_t> bytes() const {
    return {buffer->data, static_cast<std::size_t>(urb().buffer_length)};
  }
  void finish(int status, std::size_t length) const {
    urb().status = status;
    urb().actual_length = static_cast<int>(length);
  }
};

// The state of a client: one open file descriptor of the device file.
struct Client {
  double last_call = 0;
  // Keeps the client's address from being reused while this reference exists.
  UmockdevRef<UMockdevIoctlClient> handle;
  bool is_gone = false;  // the device that this client opened has been unplugged
  std::set<unsigned> claimed;
  std::deque<UsbTransfer> reading, finished;
  // Set while the client waits for a finished transfer. The transfer's address will be stored in
  // `slot`.
  UmockdevRef<UMockdevIoctlClient> waiting;
  UmockdevRef<UMockdevIoctlData> slot;
  double waiting_until = 0;
};

}  // namespace

class UsbBoard::Impl {
 public:
  explicit Impl(UsbBoardEvents events);
  ~Impl();

  // Returns the environment variable, as "NAME=value", by which a process finds the simulated bus.
  std::string bus() const;
  std::vector<std::string> environment() const;
  Expected<void> plug(const UsbBoardSettings& settings);
  void unplug();
  template <class Change>
  void change(Change how);
  template <class Question>
  auto ask(Question question);

 private:
  static gboolean handle_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    return static_cast<gboolean>(static_cast<Impl*>(self)->on_call(client));
  }
  static void handle_vanished(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    static_cast<Impl*>(self)->forget(client);
  }
  bool on_call(UMockdevIoctlClient* client);
  void forget(UMockdevIoctlClient* client);
  double now() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  void call(UMockdevIoctlClient* handle, Client& client);
  void claim(UMockdevIoctlClient* handle, Client& client, bool on);
  void submit(UMockdevIoctlClient* handle, Client& client);
  void discard(UMockdevIoctlClient* handle, Client& client);
  void reap(UMockdevIoctlClient* handle, Client& client);
  void control(const UsbTransfer& transfer);
  std::size_t answer(const Setup& setup, std::span<std::uint8_t> bytes);
  // Advances the firmware's time, delivers its output to clients, and reports changes of table,
  // laser and motor.
  void settle();
  void hand_out(Client& client, double at);
  void deliver(Client& client);
  void run();
  double next_event() const;

  const UsbBoardEvents events_;
  const Clock::time_point start_ = Clock::now();
  const UmockdevRef<UMockdevTestbed> testbed_{umockdev_testbed_new()};
  const UmockdevRef<UMockdevIoctlBase> calls_{umockdev_ioctl_base_new()};

  mutable std::mutex mutex_;         // guards the members below
  GMainContext* context_ = nullptr;  // the context of umockdev's thread
  std::condition_variable changed_;
  UsbBoardSettings settings_;
  std::unique_ptr<Firmware> firmware_;  // null while unplugged
  bool is_dtr_set_ = false, is_closing_ = false;
  std::string unread_;
  double last_in_ = 0;
  // The table's angle in degrees at power-on, and its angle now.
  double base_ = 0, table_ = 0;
  // The angle at which the table last rested, and the target of the motion.
  double stood_ = 0, goal_ = 0;
  bool is_laser_on_ = false, is_motor_on_ = false;
  std::map<UMockdevIoctlClient*, Client> clients_;
  std::thread timer_;
};

namespace {

struct Completion {
  UmockdevRef<UMockdevIoctlClient> client;
  long result = 0;
  int error = 0;
  // Set only if the call returns a finished transfer. The address of that transfer, `reaped`, is
  // stored in `slot`.
  UmockdevRef<UMockdevIoctlData> slot, reaped;
};

// Completes a call in umockdev's own thread, which owns `context`. If another thread completed the
// call, umockdev would occasionally lose the client's next call. g_main_context_invoke() is no
// solution, because it runs in the calling thread while the context is idle.
void complete(GMainContext* context, Completion completion) {
  const GSourceFunc run = [](gpointer data) {
    const auto& [client, result, error, slot, reaped] = *static_cast<Completion*>(data);
    if (slot && reaped) umockdev_ioctl_data_set_ptr(slot.get(), 0, reaped.get());
    umockdev_ioctl_client_complete(client.get(), result, error);
    return static_cast<gboolean>(G_SOURCE_REMOVE);
  };
  const GDestroyNotify drop = [](gpointer data) { delete static_cast<Completion*>(data); };
  GSource* source = g_idle_source_new();
  g_source_set_priority(source, G_PRIORITY_DEFAULT);
  g_source_set_callback(source, run, new Completion(std::move(completion)), drop);
  g_source_attach(source, context);
  g_source_unref(source);
}

void complete(GMainContext* context, UMockdevIoctlClient* client, long result, int error) {
  complete(context, {.client = share(client), .result = result, .error = error});
}

UmockdevRef<UMockdevIoctlData> resolve(UMockdevIoctlData* data, std::size_t offset,
                                       std::size_t size) {
  return UmockdevRef<UMockdevIoctlData>(umockdev_ioctl_data_resolve(data, offset, size, nullptr));
}

// Returns whether the client's process has ended. umockdev misses the end of some clients that are
// killed during a call. A living client that holds an interface polls for transfers continuously,
// so a silent client is dead.
bool is_dead(const Client& client, double now) {
  constexpr double kSilent = 1;
  return umockdev_ioctl_client_get_connected(client.handle.get()) == FALSE ||
         now > client.last_call + kSilent;
}

unsigned number_in(UMockdevIoctlClient* client) {
  const auto data = resolve(umockdev_ioctl_client_get_arg(client), 0, sizeof(unsigned));
  return data ? *reinterpret_cast<unsigned*>(data->data) : ~0u;
}

}  // namespace

UsbBoard::Impl::Impl(UsbBoardEvents events) : events_(std::move(events)) {
  g_signal_connect(calls_.get(), "handle-ioctl", G_CALLBACK(&handle_ioctl), this);
  g_signal_connect(calls_.get(), "client-vanished", G_CALLBACK(&handle_vanished), this);
  timer_ = std::thread([this] { run(); });
}

UsbBoard::Impl::~Impl() {
  // Waits, because a guardian process may still need the bus to switch the board off.
  wait_for_users_of(bus(), kGuardians);
  unplug();
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
    changed_.notify_all();
  }
  timer_.join();
  g_signal_handlers_disconnect_by_data(calls_.get(), this);
}

std::string UsbBoard::Impl::bus() const {
  const std::unique_ptr<char, decltype(&g_free)> root(umockdev_testbed_get_root_dir(testbed_.get()),
                                                      &g_free);
  return fmt::format("UMOCKDEV_DIR={}", root.get());
}

std::vector<std::string> UsbBoard::Impl::environment() const {
  return {bus(), fmt::format("LD_PRELOAD={}", kPreload)};
}

Expected<void> UsbBoard::Impl::plug(const UsbBoardSettings& settings) {
  unplug();
  {
    const std::lock_guard lock(mutex_);
    settings_ = settings;
    firmware_ = settings.is_fabscan ? fabscan_firmware(settings.firmware)
                                    : horus_firmware(settings.firmware);
    firmware_->restart(now());
    is_dtr_set_ = false;
    unread_.clear();
  }
  std::string hex;
  for (const std::uint8_t byte : descriptors_of(settings.transport))
    hex += fmt::format("{:02X}", byte);
  const std::string description = fmt::format(
      "P: {}\nN: bus/usb/001/002\nE: DEVNAME={}\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\n"
      "E: BUSNUM=001\nE: DEVNUM=002\nE: MAJOR=189\nE: MINOR=1\nA: busnum=1\\n\nA: devnum=2\\n\n"
      "A: bConfigurationValue=1\\n\nA: speed=12\\n\nH: descriptors={}\n",
      kPath + 4, kNode, hex);
  // Installs the call handlers before the device appears, because a program that opens the device
  // before the handlers exist would fail.
  GError* error = nullptr;
  if (umockdev_testbed_attach_ioctl(testbed_.get(), kNode, calls_.get(), &error) &&
      umockdev_testbed_add_from_string(testbed_.get(), description.c_str(), &error))
    return {};
  Unexpected failed = fail(ErrorCode::kIo, fmt::format("cannot simulate the USB board: {}; install "
                                                       "umockdev",
                                                       error->message));
  g_error_free(error);
  return failed;
}

void UsbBoard::Impl::unplug() {
  {
    const std::lock_guard lock(mutex_);
    if (!firmware_) return;
    base_ += firmware_->table(now());
    firmware_.reset();
    if (base_ != std::exchange(goal_, base_)) events_.on_goal(base_);
    for (auto& [handle, client] : clients_) {
      client.is_gone = true;
      for (; !client.reading.empty(); client.reading.pop_front()) {
        client.reading.front().finish(-ENODEV, 0);
        client.finished.push_back(std::move(client.reading.front()));
      }
      deliver(client);
    }
    if (std::exchange(is_laser_on_, false)) events_.on_laser(false);
    if (std::exchange(is_motor_on_, false)) events_.on_motor(false);
  }
  umockdev_testbed_uevent(testbed_.get(), kPath, "remove");
  umockdev_testbed_remove_device(testbed_.get(), kPath);
  umockdev_testbed_detach_ioctl(testbed_.get(), kNode, nullptr);
}

template <class Change>
void UsbBoard::Impl::change(Change how) {
  const std::lock_guard lock(mutex_);
  if (firmware_) how(*firmware_, unread_);
  settle();
}

template <class Question>
auto UsbBoard::Impl::ask(Question question) {
  const std::lock_guard lock(mutex_);
  settle();
  return question(firmware_.get(), table_);
}

bool UsbBoard::Impl::on_call(UMockdevIoctlClient* handle) {
  const std::lock_guard lock(mutex_);
  context_ = g_main_context_get_thread_default();
  Client& client = clients_[handle];
  if (!client.handle) client.handle = share(handle);
  client.last_call = now();
  call(handle, client);
  settle();
  changed_.notify_all();
  return true;
}

void UsbBoard::Impl::forget(UMockdevIoctlClient* handle) {
  const std::lock_guard lock(mutex_);
  clients_.erase(handle);
}

void UsbBoard::Impl::call(UMockdevIoctlClient* handle, Client& client) {
  const auto request = umockdev_ioctl_client_get_request(handle);
  if (request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY) {
    reap(handle, client);
  } else if (client.is_gone || !firmware_) {
    complete(context_, handle, -1, request == USBDEVFS_DISCARDURB ? EINVAL : ENODEV);
  } else if (request == USBDEVFS_GET_CAPABILITIES) {
    const auto data = resolve(umockdev_ioctl_client_get_arg(handle), 0, sizeof(unsigned));
    *reinterpret_cast<unsigned*>(data->data) = USBDEVFS_CAP_BULK_CONTINUATION;
    complete(context_, handle, 0, 0);
  } else if (request == USBDEVFS_GETDRIVER || request == USBDEVFS_IOCTL) {
    complete(context_, handle, -1, ENODATA);
  } else if (request == USBDEVFS_CLAIMINTERFACE || request == USBDEVFS_DISCONNECT_CLAIM) {
    claim(handle, client, true);
  } else if (request == USBDEVFS_RELEASEINTERFACE) {
    claim(handle, client, false);
  } else if (request == USBDEVFS_SUBMITURB) {
    submit(handle, client);
  } else if (request == USBDEVFS_DISCARDURB) {
    discard(handle, client);
  } else {
    complete(context_, handle, -1, ENOTTY);
  }
}

void UsbBoard::Impl::claim(UMockdevIoctlClient* handle, Client& client, bool on) {
  const unsigned interface = number_in(handle);
  if (on) {
    std::erase_if(clients_, [&](const auto& one) { return is_dead(one.second, now()); });
    for (const auto& [other, state] : clients_)
      if (other != handle && !state.is_gone && state.claimed.contains(interface))
        return complete(context_, handle, -1, EBUSY);
    client.claimed.insert(interface);
  } else {
    client.claimed.erase(interface);
  }
  complete(context_, handle, 0, 0);
}

// Takes the time before resolve(), which waits for the client's process. That process may be
// suspended in the meantime.
void UsbBoard::Impl::submit(UMockdevIoctlClient* handle, Client& client) {
  const auto submitted = std::chrono::system_clock::now();
  UsbTransfer transfer;
  transfer.block = resolve(umockdev_ioctl_client_get_arg(handle), 0, sizeof(usbdevfs_urb));
  if (!transfer.block) return complete(context_, handle, -1, EFAULT);
  transfer.buffer = resolve(transfer.block.get(), offsetof(usbdevfs_urb, buffer),
                            static_cast<std::size_t>(transfer.urb().buffer_length));
  if (!transfer.buffer) return complete(context_, handle, -1, EFAULT);
  complete(context_, handle, 0, 0);
  const usbdevfs_urb& urb = transfer.urb();
  if (urb.type == USBDEVFS_URB_TYPE_BULK && (urb.endpoint & 0x80) != 0) {
    client.reading.push_back(std::move(transfer));
    return;
  }
  if (urb.type == USBDEVFS_URB_TYPE_CONTROL) {
    control(transfer);
  } else {
    const auto bytes = transfer.bytes();
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    events_.on_command(text, submitted);
    firmware_->receive(text, now());
    transfer.finish(0, bytes.size());
  }
  client.finished.push_back(std::move(transfer));
}

void UsbBoard::Impl::control(const UsbTransfer& transfer) {
  constexpr std::size_t kSetup = 8;
  const Setup setup = setup_from(transfer.bytes());
  if ((setup.type & 0x80) != 0) {
    const std::size_t length = answer(setup, transfer.bytes().subspan(kSetup));
    return transfer.finish(length == 0 ? -EPIPE : 0, length);
  }
  if (const auto dtr = dtr_in(settings_.transport, setup)) {
    if (*dtr && !is_dtr_set_) firmware_->restart(now());
    is_dtr_set_ = *dtr;
  }
  transfer.finish(0, setup.length);
}

std::size_t UsbBoard::Impl::answer(const Setup& setup, std::span<std::uint8_t> bytes) {
  if (setup.type != 0x80 || setup.request != 6 || setup.value >> 8 != 3) return 0;
  const auto text = string_descriptor(setup.value & 0xff, settings_.serial);
  const std::size_t length = std::min(text.size(), bytes.size());
  std::copy_n(text.begin(), length, bytes.begin());
  return length;
}

void UsbBoard::Impl::discard(UMockdevIoctlClient* handle, Client& client) {
  // The call's argument is the address of the submitted transfer.
  const auto block = resolve(umockdev_ioctl_client_get_arg(handle), 0, sizeof(usbdevfs_urb));
  for (auto at = client.reading.begin(); block && at != client.reading.end(); ++at) {
    if (at->block->client_addr != block->client_addr) continue;
    at->finish(-ENOENT, 0);
    client.finished.push_back(std::move(*at));
    client.reading.erase(at);
    return complete(context_, handle, 0, 0);
  }
  complete(context_, handle, -1, EINVAL);
}

void UsbBoard::Impl::reap(UMockdevIoctlClient* handle, Client& client) {
  client.waiting = share(handle);
  client.slot = resolve(umockdev_ioctl_client_get_arg(handle), 0, sizeof(void*));
  client.waiting_until = now() + kHold;
  deliver(client);
}

// Delivers a finished transfer to a waiting client. If none is finished and the client has waited
// for kHold, answers that no transfer is finished yet.
void UsbBoard::Impl::deliver(Client& client) {
  if (!client.waiting) return;
  if (!client.finished.empty()) {
    complete(context_, {.client = std::move(client.waiting),
                        .slot = std::move(client.slot),
                        .reaped = std::move(client.finished.front().block)});
    client.finished.pop_front();
  } else if (client.is_gone || now() >= client.waiting_until) {
    complete(context_, client.waiting.get(), -1, client.is_gone ? ENODEV : EAGAIN);
    client.waiting.reset();
  }
}

void UsbBoard::Impl::hand_out(Client& client, double at) {
  const bool status_due = settings_.transport == UsbTransport::kFtdi && at >= last_in_ + kFtdiIdle;
  for (bool first = true; !client.reading.empty() && (!unread_.empty() || (first && status_due));
       first = false) {
    UsbTransfer transfer = std::move(client.reading.front());
    client.reading.pop_front();
    const auto bytes = packets(settings_.transport, unread_, transfer.bytes().size());
    std::copy(bytes.begin(), bytes.end(), transfer.bytes().begin());
    transfer.finish(0, bytes.size());
    client.finished.push_back(std::move(transfer));
    last_in_ = at;
  }
}

void UsbBoard::Impl::settle() {
  const double at = now();
  if (firmware_) {
    firmware_->advance(at);
    unread_ += firmware_->take_output();
    if (unread_.size() > kMostUnread) unread_.erase(0, unread_.size() - kMostUnread);
    const double goal = base_ + firmware_->goal();
    if (goal != std::exchange(goal_, goal)) events_.on_goal(goal);
    const double table = base_ + firmware_->table(at);
    if (table != std::exchange(table_, table)) events_.on_move(table);
    if (!firmware_->moving() && table != std::exchange(stood_, table)) events_.on_turn(table);
    const bool laser = firmware_->laser(), motor = firmware_->motor();
    if (laser != std::exchange(is_laser_on_, laser)) events_.on_laser(laser);
    if (motor != std::exchange(is_motor_on_, motor)) events_.on_motor(motor);
  }
  for (auto& [handle, client] : clients_) {
    hand_out(client, at);
    deliver(client);
  }
}

double UsbBoard::Impl::next_event() const {
  double next = firmware_ ? firmware_->next() : std::numeric_limits<double>::infinity();
  for (const auto& [handle, client] : clients_) {
    if (client.waiting) next = std::min(next, client.waiting_until);
    if (!client.reading.empty() && settings_.transport == UsbTransport::kFtdi)
      next = std::min(next, last_in_ + kFtdiIdle);
  }
  return next;
}

void UsbBoard::Impl::run() {
  constexpr double kLong = 3600;
  std::unique_lock lock(mutex_);
  while (!is_closing_) {
    settle();
    const std::chrono::duration<double> until(std::min(next_event(), now() + kLong));
    changed_.wait_until(lock, start_ + std::chrono::duration_cast<Clock::duration>(until));
  }
}

void enter_testbed(char** argv) {
  const char* set = std::getenv("LD_PRELOAD");
  const std::string before = set != nullptr ? set : "";
  if (before.find(kPreload) != std::string::npos) return;
  ::setenv("LD_PRELOAD", (kPreload + (':' + before)).c_str(), 1);
  ::execv("/proc/self/exe", argv);
}

UsbBoard::UsbBoard(UsbBoardEvents events) : impl_(std::make_unique<Impl>(std::move(events))) {}
UsbBoard::~UsbBoard() = default;

std::vector<std::string> UsbBoard::environment() const {
  return impl_->environment();
}
Expected<void> UsbBoard::plug(const UsbBoardSettings& settings) {
  return impl_->plug(settings);
}
void UsbBoard::unplug() {
  impl_->unplug();
}

void UsbBoard::stall() {
  impl_->change([](Firmware& firmware, std::string&) { firmware.stall(); });
}

void UsbBoard::babble(const std::string& bytes) {
  impl_->change([&](Firmware&, std::string& unread) { unread += bytes; });
}

double UsbBoard::table() const {
  return impl_->ask([](const Firmware*, double table) { return table; });
}

bool UsbBoard::laser() const {
  return impl_->ask(
      [](const Firmware* firmware, double) { return firmware != nullptr && firmware->laser(); });
}

bool UsbBoard::motor() const {
  return impl_->ask(
      [](const Firmware* firmware, double) { return firmware != nullptr && firmware->motor(); });
}

}  // namespace vitrine::acquisition::rig
