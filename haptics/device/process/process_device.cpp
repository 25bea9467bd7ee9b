// SPDX-License-Identifier: MIT
#include "haptics/device/process/process_device.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <utility>

#include "engine/base/clock.h"
#include "engine/base/helper_process.h"
#include "engine/base/system_failure.h"
#include "haptics/device/process/device_page.h"
#include "haptics/device/process/force_table.h"

namespace catena::haptics {

namespace {

using process::DevicePage;

constexpr int kOpenMs = 60'000;
constexpr double kEndS = 3, kLostS = 0.1;

Error cannot_start(const std::string& device, const std::string& why) {
  return Error{device + ": the process for the device cannot be started: " + why, true};
}

/// Mapping of the shared memory page. Its size is sealed, so that neither side can truncate it.
class SharedPage {
 public:
  static Result<SharedPage> make(const std::string& device) {
    FileDescriptor file(::memfd_create("catena-device", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!file || ::ftruncate(file.get(), sizeof(DevicePage)) != 0 ||
        ::fcntl(file.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
      return cannot_start(device, describe_errno(errno));
    void* const at = ::mmap(nullptr, sizeof(DevicePage), PROT_READ | PROT_WRITE, MAP_SHARED, file.get(), 0);
    if (at == MAP_FAILED) return cannot_start(device, describe_errno(errno));
    return SharedPage(std::move(file), new (at) DevicePage{});
  }
  SharedPage(SharedPage&& other) noexcept : file_(std::move(other.file_)), page_(std::exchange(other.page_, nullptr)) {}
  SharedPage& operator=(SharedPage&&) = delete;
  ~SharedPage() {
    if (page_ != nullptr) ::munmap(page_, sizeof(DevicePage));
  }
  DevicePage& operator*() const { return *page_; }
  int fd() const { return file_.get(); }

 private:
  SharedPage(FileDescriptor file, DevicePage* page) : file_(std::move(file)), page_(page) {}
  FileDescriptor file_;
  DevicePage* page_;
};

class ProcessDevice final : public Device {
 public:
  ProcessDevice(SharedPage memory, HelperProcess process, FileDescriptor lifeline, std::string table)
      : memory_(std::move(memory)),
        process_(std::move(process)),
        lifeline_(std::move(lifeline)),
        table_(std::move(table)),
        page_(*memory_) {
    const process::DeviceDescription& is = page_.description;
    capabilities_.name = is.name;
    capabilities_.workspace_m = is.workspace_m;
    capabilities_.workspace_center_m = is.workspace_center_m;
    capabilities_.button_count = is.button_count;
    capabilities_.has_orientation = is.has_orientation;
    capabilities_.has_vibration = is.has_vibration;
    capabilities_.max_force_n = is.max_force_n;
    capabilities_.max_torque_nm = is.max_torque_nm;
    capabilities_.mechanics = is.mechanics;
  }
  /// Closing the lifeline ends the force; the destructor waits for the process, so that its table is complete.
  ~ProcessDevice() override {
    lifeline_.close();
    process_.wait(kEndS);
  }

  const DeviceCapabilities& capabilities() const override { return capabilities_; }

  DeviceInput read() noexcept override {
    page_.poses.acquire();
    const process::DevicePose& pose = page_.poses.front();
    DeviceInput input = pose.input;
    if (pose.written_ns == 0) {
      input.status = DeviceStatus::starting;
      return input;
    }
    input.age_s += 1e-9 * static_cast<double>(std::max<std::int64_t>(0, now_ns() - pose.written_ns));
    const std::uint32_t takeovers = page_.takeovers.load(std::memory_order_acquire);
    // the device is reported lost once per takeover, so that the force ramps in
    if (input.age_s > kLostS || takeovers != seen_takeovers_) input.status = DeviceStatus::lost;
    seen_takeovers_ = takeovers;
    return input;
  }

  void write(const DeviceOutput& output) noexcept override { page_.commands.publish({output, seen_takeovers_}); }
  void stop() noexcept override { page_.stopped = 1; }
  void resume() noexcept override { page_.stopped = 0; }
  bool zero_force_confirmed() const noexcept override { return page_.zero_force_confirmed != 0; }

  Outcome check_output_files() const override {
    const int code = page_.table_error;
    return code == 0 ? Outcome(Done{}) : system_error(table_ + ": cannot write all rows", code);
  }

  std::string status_text() const override {
    if (const Outcome whole = check_output_files(); !whole) return whole.error().message;
    page_.status.acquire();
    const process::StatusText words = page_.status.front();
    return {words.text, ::strnlen(words.text, sizeof words.text)};
  }

 private:
  SharedPage memory_;
  HelperProcess process_;
  FileDescriptor lifeline_;
  std::string table_;
  DevicePage& page_;
  DeviceCapabilities capabilities_;
  std::uint32_t seen_takeovers_ = 0;  ///< haptic thread
};

template <std::size_t N>
bool fits(char (&to)[N], const std::string& text) {
  std::snprintf(to, N, "%s", text.c_str());
  return text.size() < N;
}

}  // namespace

Result<std::unique_ptr<Device>> open_in_process(const std::string& device, const std::string& log, const DeviceSettings& settings) {
  CATENA_TRY(SharedPage memory, SharedPage::make(device));
  DevicePage& page = *memory;
  page.rate_hz = settings.rate_hz;
  page.silence_timeout_ms = std::max<std::uint32_t>(50, static_cast<std::uint32_t>(4000 / settings.rate_hz));
  page.force_gain = settings.force_gain;
  if (!fits(page.device, device) || !fits(page.firmware, settings.firmware))
    return Error{device + ": the name of the device or of the firmware is too long for a separate process"};
  CATENA_TRY(const FileDescriptor table, process::open_force_table(log));
  // if the process does not start, remove the empty table
  bool starts = false;
  const std::shared_ptr<void> tidy(nullptr, [&](void*) {
    if (!starts && !log.empty()) ::unlink(log.c_str());
  });
  int pair[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0) return cannot_start(device, describe_errno(errno));
  FileDescriptor ours(pair[0]);
  std::optional<HelperProcess> process;
  {
    const FileDescriptor theirs(pair[1]);
    const int given[] = {memory.fd(), theirs.get(), table.get()};
    CATENA_TRY(HelperProcess started, HelperProcess::start(helper_path("catena-device"), given));
    process.emplace(std::move(started));
  }  // only the process holds the other end, so that the end of the process is detected
  pollfd line{ours.get(), POLLIN, 0};
  int ready_count = 0;
  do ready_count = ::poll(&line, 1, kOpenMs);
  while (ready_count < 0 && errno == EINTR);
  char answer = 0;
  if (ready_count != 1 || ::read(ours.get(), &answer, 1) != 1) return cannot_start(device, "catena-device does not answer");
  if (answer != process::kReady)
    return Error{std::string(page.error_text, ::strnlen(page.error_text, sizeof page.error_text)), page.is_machine_error};
  starts = true;
  return std::unique_ptr<Device>(std::make_unique<ProcessDevice>(std::move(memory), std::move(*process), std::move(ours), log));
}

}  // namespace catena::haptics
