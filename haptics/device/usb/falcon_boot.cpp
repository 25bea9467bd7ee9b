#include "haptics/device/usb/falcon_boot.h"

#include <fmt/format.h>

#include <string_view>

namespace catena::haptics::usb {
namespace {

constexpr int kBootWriteMs = 500, kBootReadMs = 100;
constexpr int kProbeReads = 10, kProbeReadMs = 20;
constexpr int kHandshakeReads = 4, kEchoIdleReads = 20;  // an idle device sends a packet each 16 ms

Error unplugged(UsbError error) {
  return Error{fmt::format("Falcon: {} while its firmware was being started; plug it in again", usb_error_text(error))};
}

struct Step {
  bool done = false;
  bool cancelled = false;
  UsbError error = UsbError::none;
  std::string what{};  ///< why not
};
Step failed(std::string what) { return {.what = std::move(what)}; }
Step failed(UsbError error, std::string_view where) { return {.error = error, .what = fmt::format("{} {}", usb_error_text(error), where)}; }

Step cancelled() { return {.cancelled = true, .what = "given up"}; }
bool given_up(const FalconBootOptions& options) { return options.give_up && options.give_up(); }

#define CATENA_USB(call, where) \
  if (const UsbError usb_error = (call); usb_error != UsbError::none) return failed(usb_error, where)

// (1)-(2): the boot loader answers
Step shake_hands(Ftdi& ftdi, const FalconBootOptions& options) {
  CATENA_USB(ftdi.purge(), "at the boot mode");
  CATENA_USB(ftdi.latency_ms(16), "at the boot mode");
  CATENA_USB(ftdi.baud(FtdiBaud::boot_9600), "at the boot mode");
  CATENA_USB(ftdi.eight_n_one(), "at the boot mode");
  CATENA_USB(ftdi.no_flow_control(), "at the boot mode");
  CATENA_USB(ftdi.rts_low(), "at the boot mode");
  CATENA_USB(ftdi.dtr_low(), "at the boot mode");
  CATENA_USB(ftdi.dtr_high(), "at the boot mode");
  constexpr std::uint8_t kHello[] = {0x0A, 0x43, 0x0D};
  constexpr std::uint8_t kAnswer[] = {0x0A, 0x44, 0x2C, 0x0D};  // some systems put a 0 before it
  std::size_t matched = 0;
  for (int attempt = 0; attempt < options.handshake_tries; ++attempt) {
    UsbError error = ftdi.write(kHello, kBootWriteMs);
    if (error == UsbError::gone) return failed(error, "at the hand shake");
    for (int i = 0; i < kHandshakeReads && error == UsbError::none; ++i) {
      if (given_up(options)) return cancelled();
      std::span<const std::uint8_t> payload;
      error = ftdi.read(payload, kBootReadMs);
      if (error == UsbError::gone) return failed(error, "at the hand shake");
      for (const std::uint8_t byte : payload) {
        matched = byte == kAnswer[matched] ? matched + 1 : (byte == kAnswer[0] ? 1 : 0);
        if (matched == std::size(kAnswer)) return {.done = true};
      }
    }
  }
  return failed(fmt::format("the boot loader did not answer {} hand shakes", options.handshake_tries));
}

// (3): the loader listens for an image
Step ready_for_image(Ftdi& ftdi, const FalconBootOptions& options) {
  CATENA_USB(ftdi.dtr_low(), "before the image");
  CATENA_USB(ftdi.baud(FtdiBaud::image_140000), "before the image");
  constexpr std::uint8_t kAsk[] = {0x41};
  CATENA_USB(ftdi.write(kAsk, kBootWriteMs), "before the image");
  for (int idle = 0; idle < kEchoIdleReads; ++idle) {
    if (given_up(options)) return cancelled();
    std::span<const std::uint8_t> payload;
    const UsbError error = ftdi.read(payload, kBootReadMs);
    if (error != UsbError::none && error != UsbError::timeout) return failed(error, "before the image");
    // what is left of a hand shake may come before it
    for (const std::uint8_t byte : payload)
      if (byte == kAsk[0]) return {.done = true};
  }
  return failed("the boot loader did not ask for the image");
}

// (4): chunk by chunk, each byte comes back
Step send_image(Ftdi& ftdi, std::span<const std::uint8_t> image, int attempt, const FalconBootOptions& options) {
  std::size_t sent = 0, echoed = 0;
  while (echoed < image.size()) {
    if (options.progress && !options.progress(attempt, static_cast<double>(echoed) / static_cast<double>(image.size()))) return cancelled();
    const auto chunk = image.subspan(sent, std::min(kFtdiPayloadBytes, image.size() - sent));
    CATENA_USB(ftdi.write(chunk, kBootWriteMs), fmt::format("at byte {} of the image", sent));
    sent += chunk.size();
    for (int idle = 0; echoed < sent; ++idle) {
      if (given_up(options)) return cancelled();
      if (idle == kEchoIdleReads) return failed(fmt::format("no echo of byte {} of the image", echoed));
      std::span<const std::uint8_t> payload;
      const UsbError error = ftdi.read(payload, kBootReadMs);
      if (error != UsbError::none && error != UsbError::timeout) return failed(error, fmt::format("at byte {} of the image", echoed));
      if (!payload.empty()) idle = -1;
      for (const std::uint8_t byte : payload) {
        if (echoed == sent) return failed(fmt::format("an echo of more than the {} bytes sent", sent));
        if (byte != image[echoed])
          return failed(fmt::format("byte {} of the image came back as 0x{:02X} where 0x{:02X} was expected", echoed, byte, image[echoed]));
        ++echoed;
      }
    }
  }
  return {.done = true};
}

// firmware answers an I/O packet by a frame; a boot loader that echoes it does not run
Step look(Ftdi& ftdi, const FalconBootOptions& options) {
  CATENA_USB(falcon_run_mode(ftdi), "at the run mode");
  // all three LEDs: as a frame it would be three buttons at once, so that an echo is told from an answer
  const FalconPacket ask = encode_command({.control = kFalconRed | kFalconGreen | kFalconBlue});
  FalconFramer framer;
  UsbError last = UsbError::none;
  for (int attempt = 0; attempt < options.probe_tries; ++attempt) {
    last = ftdi.write(ask, kProbeReadMs);
    if (last == UsbError::gone) return failed(last, "at the first packets");
    for (int i = 0; i < kProbeReads && last == UsbError::none; ++i) {
      if (given_up(options)) return cancelled();
      std::span<const std::uint8_t> payload;
      last = ftdi.read(payload, kProbeReadMs);
      if (last == UsbError::gone) return failed(last, "at the first packets");
      for (const std::uint8_t byte : payload) {
        FalconFrame frame;
        if (!framer.push(byte, frame)) continue;
        if (encode_frame(frame) != ask) return {.done = true};
        i = kProbeReads;  // an echo
      }
    }
  }
  return {.error = last == UsbError::timeout ? UsbError::none : last, .what = "no firmware answers"};
}

}  // namespace

UsbError falcon_run_mode(Ftdi& ftdi) noexcept {
  UsbError error = ftdi.purge();
  if (error == UsbError::none) error = ftdi.latency_ms(1);
  if (error == UsbError::none) error = ftdi.baud(FtdiBaud::run_1500000);
  if (error == UsbError::none) error = ftdi.purge();
  return error;
}

Result<bool> falcon_is_running(Ftdi& ftdi, const FalconBootOptions& options) {
  const Step step = look(ftdi, options);
  if (step.cancelled) return Error{"Falcon: given up while it was looked at"};
  if (!step.done && step.error == UsbError::gone) return unplugged(step.error);
  return step.done;
}

Outcome falcon_boot(Ftdi& ftdi, std::span<const std::uint8_t> image, const FalconBootOptions& options,
                    std::atomic<std::uint64_t>* uploads) {
  CATENA_TRY(const bool running, falcon_is_running(ftdi, options));
  if (running) return Done{};
  if (image.empty())
    return Error{
        "Falcon: no firmware runs in it and none was given; --firmware FILE, or \"firmware\" in the scene's \"device\", was expected: the "
        "vendor's image (a TI C2000 boot stream, part of Novint's driver package), which Catena may not ship"};
  Step step;
  int silent = 0;
  for (int attempt = 1; attempt <= options.tries; ++attempt) {
    if (uploads != nullptr) count(*uploads);
    if (options.progress && !options.progress(attempt, 0)) return Error{"Falcon: given up before its firmware was sent"};
    step = shake_hands(ftdi, options);
    silent = step.done ? 0 : silent + 1;
    if (step.done) step = ready_for_image(ftdi, options);
    if (step.done) step = send_image(ftdi, image, attempt, options);
    if (step.done) step = look(ftdi, options);
    if (step.done) return Done{};
    if (step.cancelled) return Error{"Falcon: given up while its firmware was being sent"};
    if (step.error == UsbError::gone) return unplugged(step.error);
    // twice a hundred hand shakes without an answer: nobody is there
    if (silent == 2) return Error{fmt::format("Falcon: {}; unplug it, power and USB, wait a moment, and plug it in again", step.what)};
  }
  return Error{
      fmt::format("Falcon: its firmware could not be sent in {} tries, at last because: {}; another USB port, or the right image for this "
                  "device, may help",
                  options.tries, step.what)};
}

}  // namespace catena::haptics::usb
