// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/usb_serial.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "acquisition/device/usb_device.h"
#include "acquisition/device/usb_transfer.h"

namespace vitrine::acquisition {
namespace {

constexpr std::size_t kMostUnread = 1 << 20;
constexpr std::chrono::seconds kClaimTimeout{5};

struct TransferDeleter {
  void operator()(libusb_transfer* transfer) const { libusb_free_transfer(transfer); }
};

// A serial line over USB. One thread handles libusb's events. Two IN transfers are always pending,
// so that no input is missed.
class UsbSerial final : public SerialPort {
 public:
  UsbSerial(std::string name, UsbContext context, UsbDevice device, SerialEndpoints line)
      : name_(std::move(name)),
        context_(std::move(context)),
        serial_(std::move(device.serial)),
        socket_(std::move(device.port)),
        handle_(std::move(device.handle)),
        line_(line) {}
  ~UsbSerial() override;

  Expected<void> start(int baud);

  const std::string& name() const override { return name_; }
  const std::string& serial() const override { return serial_; }
  const std::string& socket() const override { return socket_; }
  Expected<void> write(std::string_view bytes) override;
  Expected<std::string> read(Clock::time_point deadline) override;
  void cancel() noexcept override;
  Expected<void> restart_controller() override;

 private:
  struct Incoming {
    std::unique_ptr<libusb_transfer, TransferDeleter> transfer;
    std::array<std::uint8_t, 512> bytes{};
    bool is_pending = false;
  };

  std::uint8_t control_index() const {
    return static_cast<std::uint8_t>(std::max(0, line_.control_interface));
  }
  Expected<void> claim();
  Expected<void> send(const ControlRequest& request);
  Expected<void> listen();
  void watch_for_unplugging();
  void handle_events();
  void stop_listening();
  bool anything_pending();
  void arrived(Incoming& incoming);
  void mark_gone();

  static void LIBUSB_CALL on_transfer(libusb_transfer* transfer);
  static int LIBUSB_CALL on_unplugged(libusb_context*, libusb_device* device, libusb_hotplug_event,
                                      void* self);

  const std::string name_;
  const UsbContext context_;
  const std::string serial_, socket_;
  const UsbHandle handle_;
  const SerialEndpoints line_;
  std::vector<int> claimed_;
  std::array<Incoming, 2> incoming_;
  libusb_hotplug_callback_handle hotplug_ = 0;
  bool is_watching_ = false;
  std::thread events_;
  std::atomic<bool> is_done_{false};

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::vector<std::uint8_t> unread_;
  bool is_closing_ = false, is_gone_ = false, is_cancelled_ = false;
};

Expected<void> UsbSerial::start(int baud) {
  libusb_set_auto_detach_kernel_driver(handle_.get(), 1);
  if (auto claimed = claim(); !claimed) return claimed;
  watch_for_unplugging();
  events_ = std::thread([this] { handle_events(); });
  for (const ControlRequest& request : set_up(line_.chip, baud, control_index()))
    if (auto sent = send(request); !sent) return sent;
  if (auto sent = send(modem_lines(line_.chip, true, control_index())); !sent) return sent;
  return listen();
}

// Retries for a while, because the guardian of a process that has just died may still hold the
// device.
Expected<void> UsbSerial::claim() {
  const auto deadline = Clock::now() + kClaimTimeout;
  for (const int interface : {line_.control_interface, line_.data_interface}) {
    if (interface < 0) continue;
    int code = libusb_claim_interface(handle_.get(), interface);
    while (code == LIBUSB_ERROR_BUSY && Clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      code = libusb_claim_interface(handle_.get(), interface);
    }
    if (code != LIBUSB_SUCCESS) return tl::unexpected(usb_error(name_, "cannot be claimed", code));
    claimed_.push_back(interface);
  }
  return {};
}

Expected<void> UsbSerial::send(const ControlRequest& request) {
  const int code = send_control(handle_.get(), request);
  if (code != LIBUSB_SUCCESS)
    return tl::unexpected(usb_error(name_, "rejects its configuration", code));
  return {};
}

void UsbSerial::watch_for_unplugging() {
  libusb_device* device = libusb_get_device(handle_.get());
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  is_watching_ = libusb_hotplug_register_callback(context_.get(), LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
                                                  0, descriptor.idVendor, descriptor.idProduct,
                                                  LIBUSB_HOTPLUG_MATCH_ANY, &on_unplugged, this,
                                                  &hotplug_) == LIBUSB_SUCCESS;
}

int LIBUSB_CALL UsbSerial::on_unplugged(libusb_context*, libusb_device* device,
                                        libusb_hotplug_event, void* self) {
  auto* port = static_cast<UsbSerial*>(self);
  if (device == libusb_get_device(port->handle_.get())) port->mark_gone();
  return 0;
}

void UsbSerial::mark_gone() {
  const std::lock_guard lock(mutex_);
  is_gone_ = true;
  changed_.notify_all();
}

// Allocates all transfers before submitting the first, because on_transfer() iterates over all of
// them.
Expected<void> UsbSerial::listen() {
  for (Incoming& incoming : incoming_) {
    incoming.transfer.reset(libusb_alloc_transfer(0));
    if (!incoming.transfer) return fail(ErrorCode::kIo, "out of memory for a USB transfer");
    libusb_fill_bulk_transfer(incoming.transfer.get(), handle_.get(), line_.in,
                              incoming.bytes.data(), static_cast<int>(incoming.bytes.size()),
                              &on_transfer, this, 0);
  }
  for (Incoming& incoming : incoming_) {
    const std::lock_guard lock(mutex_);
    const int code = libusb_submit_transfer(incoming.transfer.get());
    if (code != LIBUSB_SUCCESS) return tl::unexpected(usb_error(name_, "cannot be read", code));
    incoming.is_pending = true;
  }
  return {};
}

void LIBUSB_CALL UsbSerial::on_transfer(libusb_transfer* transfer) {
  auto* port = static_cast<UsbSerial*>(transfer->user_data);
  for (Incoming& incoming : port->incoming_)
    if (incoming.transfer.get() == transfer) port->arrived(incoming);
}

void UsbSerial::arrived(Incoming& incoming) {
  const libusb_transfer& transfer = *incoming.transfer;
  const std::lock_guard lock(mutex_);
  const auto length = static_cast<std::size_t>(std::max(0, transfer.actual_length));
  append_payload(line_.chip, std::span(incoming.bytes).first(length), line_.packet_size, unread_);
  if (unread_.size() > kMostUnread) unread_.clear();  // no valid answer is that long
  const bool usable = transfer.status == LIBUSB_TRANSFER_COMPLETED;
  incoming.is_pending =
      usable && !is_closing_ && libusb_submit_transfer(incoming.transfer.get()) == LIBUSB_SUCCESS;
  if (!incoming.is_pending && !is_closing_) is_gone_ = true;
  changed_.notify_all();
}

void UsbSerial::handle_events() {
  while (!is_done_) {
    timeval timeout{.tv_sec = 1, .tv_usec = 0};
    libusb_handle_events_timeout_completed(context_.get(), &timeout, nullptr);
  }
}

Expected<void> UsbSerial::write(std::string_view bytes) {
  const int code = send_bulk(handle_.get(), line_.out, bytes);
  if (code != LIBUSB_SUCCESS) return tl::unexpected(usb_error(name_, "does not accept data", code));
  return {};
}

Expected<std::string> UsbSerial::read(Clock::time_point deadline) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, deadline,
                      [this] { return is_cancelled_ || is_gone_ || !unread_.empty(); });
  if (is_cancelled_)
    return fail(ErrorCode::kState, name_ + " was stopped; open the scanner again to continue");
  if (is_gone_ && unread_.empty())
    return tl::unexpected(usb_error(name_, "", LIBUSB_ERROR_NO_DEVICE));
  const std::string bytes(unread_.begin(), unread_.end());
  unread_.clear();
  return bytes;
}

void UsbSerial::cancel() noexcept {
  const std::lock_guard lock(mutex_);
  is_cancelled_ = true;
  changed_.notify_all();
}

Expected<void> UsbSerial::restart_controller() {
  if (auto sent = send(modem_lines(line_.chip, false, control_index())); !sent) return sent;
  return send(modem_lines(line_.chip, true, control_index()));
}

bool UsbSerial::anything_pending() {
  for (const Incoming& incoming : incoming_)
    if (incoming.is_pending) return true;
  return false;
}

void UsbSerial::stop_listening() {
  std::unique_lock lock(mutex_);
  is_closing_ = true;
  for (Incoming& incoming : incoming_)
    if (incoming.is_pending) libusb_cancel_transfer(incoming.transfer.get());
  changed_.wait(lock, [this] { return !anything_pending(); });
}

UsbSerial::~UsbSerial() {
  if (events_.joinable()) {
    stop_listening();
    if (is_watching_) libusb_hotplug_deregister_callback(context_.get(), hotplug_);
    is_done_ = true;
    libusb_interrupt_event_handler(context_.get());
    events_.join();
  } else if (is_watching_) {
    libusb_hotplug_deregister_callback(context_.get(), hotplug_);
  }
  for (const int interface : claimed_)
    libusb_release_interface(handle_.get(), interface);
}

}  // namespace

Expected<std::unique_ptr<SerialPort>> open_usb_serial(const BoardSelector& selector, int baud) {
  auto context = open_usb();
  if (!context) return tl::unexpected(context.error());
  auto device = open_usb_device(context->get(), selector);
  if (!device) return tl::unexpected(device.error());
  const auto line = find_serial_line(libusb_get_device(device->handle.get()), selector);
  if (!line) return tl::unexpected(line.error());
  auto port = std::make_unique<UsbSerial>(usb_name(selector), std::move(*context),
                                          std::move(*device), *line);
  if (auto started = port->start(baud); !started) return tl::unexpected(started.error());
  return port;
}

}  // namespace vitrine::acquisition
