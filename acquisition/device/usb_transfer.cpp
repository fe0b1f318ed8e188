// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/usb_transfer.h"

#include <condition_variable>
#include <mutex>
#include <vector>

namespace vitrine::acquisition {
namespace {

constexpr unsigned kDeadline = 1000;  // milliseconds; after that, libusb cancels the transfer

class Outgoing {
 public:
  Outgoing() : transfer_(libusb_alloc_transfer(0)) {}
  ~Outgoing() { libusb_free_transfer(transfer_); }
  Outgoing(const Outgoing&) = delete;
  Outgoing& operator=(const Outgoing&) = delete;

  libusb_transfer* transfer() { return transfer_; }  // null if memory has run out
  int carry_out();

  static void LIBUSB_CALL on_complete(libusb_transfer* transfer);

 private:
  libusb_transfer* const transfer_;
  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  bool is_complete_ = false;
};

// Notifies while holding the mutex. If it unlocked the mutex first, the waiting thread could
// destroy this object before the notification.
void LIBUSB_CALL Outgoing::on_complete(libusb_transfer* transfer) {
  auto* self = static_cast<Outgoing*>(transfer->user_data);
  const std::lock_guard lock(self->mutex_);
  self->is_complete_ = true;
  self->changed_.notify_all();
}

int code_of(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_COMPLETED:
      return LIBUSB_SUCCESS;
    case LIBUSB_TRANSFER_TIMED_OUT:
      return LIBUSB_ERROR_TIMEOUT;
    case LIBUSB_TRANSFER_STALL:
      return LIBUSB_ERROR_PIPE;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return LIBUSB_ERROR_NO_DEVICE;
    default:
      return LIBUSB_ERROR_IO;
  }
}

int Outgoing::carry_out() {
  const int code = libusb_submit_transfer(transfer_);
  if (code != LIBUSB_SUCCESS) return code;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return is_complete_; });
  return code_of(transfer_->status);
}

}  // namespace

int send_bulk(libusb_device_handle* device, std::uint8_t endpoint, std::string_view bytes) {
  std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
  Outgoing outgoing;
  if (outgoing.transfer() == nullptr) return LIBUSB_ERROR_NO_MEM;
  libusb_fill_bulk_transfer(outgoing.transfer(), device, endpoint, data.data(),
                            static_cast<int>(data.size()), &Outgoing::on_complete, &outgoing,
                            kDeadline);
  return outgoing.carry_out();
}

int send_control(libusb_device_handle* device, const ControlRequest& request) {
  std::vector<std::uint8_t> data(LIBUSB_CONTROL_SETUP_SIZE);
  data.insert(data.end(), request.data.begin(), request.data.end());
  libusb_fill_control_setup(data.data(), request.type, request.request, request.value,
                            request.index, static_cast<std::uint16_t>(request.data.size()));
  Outgoing outgoing;
  if (outgoing.transfer() == nullptr) return LIBUSB_ERROR_NO_MEM;
  libusb_fill_control_transfer(outgoing.transfer(), device, data.data(), &Outgoing::on_complete,
                               &outgoing, kDeadline);
  return outgoing.carry_out();
}

}  // namespace vitrine::acquisition
