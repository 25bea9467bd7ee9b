// SPDX-License-Identifier: MIT
#include "render/image/exr_writer.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>

#include "engine/base/output_file.h"
#include "engine/base/result.h"

namespace catena::render {
namespace {

/// Output stream of OpenEXR, which seeks back to write its table of rows: in a regular file, or in a memory copy for a pipe.
class Stream : public Imf::OStream {
 public:
  explicit Stream(OutputFile& file) : Imf::OStream("image"), file_(file) {
    struct stat what {};
    seeks_ = fstat(fileno(file.stream()), &what) == 0 && S_ISREG(what.st_mode);
  }
  void write(const char* text, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (seeks_) {
      file_.write({text, size});
    } else {
      if (held_.size() < at_ + size) held_.resize(at_ + size);
      std::copy_n(text, size, held_.begin() + static_cast<std::ptrdiff_t>(at_));
    }
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t to) override {
    at_ = to;
    if (seeks_) file_.seek(to);
  }
  void finish() {
    if (!seeks_) file_.write(held_);
  }

 private:
  OutputFile& file_;
  bool seeks_ = false;
  std::uint64_t at_ = 0;
  std::string held_;
};

}  // namespace

struct ExrWriter::Impl {
  Impl(OutputFile output, const ExrFormat& f, const std::string& name) : file(std::move(output)), format(f), path(name), stream(file) {}
  Error error(const std::exception& e) const { return Error{path + ": the image cannot be encoded as EXR: " + e.what()}; }

  OutputFile file;
  ExrFormat format;
  std::string path;
  Stream stream;
  std::optional<Imf::OutputFile> exr;  // destroyed before the stream
};

ExrWriter::ExrWriter(std::unique_ptr<Impl> parts) : impl_(std::move(parts)) {}
ExrWriter::~ExrWriter() = default;
ExrWriter::ExrWriter(ExrWriter&&) noexcept = default;

Result<ExrWriter> ExrWriter::open(const std::string& path, const ExrFormat& format) {
  CATENA_ASSERT(format.width > 0 && format.height > 0 && !format.channels.empty());
  CATENA_TRY(OutputFile file, OutputFile::open(path));
  auto parts = std::make_unique<Impl>(std::move(file), format, path);
  try {
    Imf::Header header(static_cast<int>(format.width), static_cast<int>(format.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const std::string& channel : format.channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    if (!format.comments.empty()) Imf::addComments(header, format.comments);
    parts->exr.emplace(parts->stream, header);
  } catch (const std::exception& e) {
    return parts->error(e);
  }
  return ExrWriter(std::move(parts));
}

Outcome ExrWriter::write_rows(std::span<const float> values) {
  const std::size_t channels = impl_->format.channels.size(), row = channels * impl_->format.width;
  CATENA_ASSERT(values.size() % row == 0);
  try {
    // OpenEXR counts rows from the top of the whole image
    const std::ptrdiff_t done = impl_->exr->currentScanLine() * static_cast<std::ptrdiff_t>(row * sizeof(float));
    char* first = const_cast<char*>(reinterpret_cast<const char*>(values.data())) - done;
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < channels; ++c)
      frame.insert(impl_->format.channels[c],
                   Imf::Slice(Imf::FLOAT, first + c * sizeof(float), channels * sizeof(float), row * sizeof(float)));
    impl_->exr->setFrameBuffer(frame);
    impl_->exr->writePixels(static_cast<int>(values.size() / row));
  } catch (const std::exception& e) {
    return impl_->error(e);
  }
  if (impl_->file.failed()) return impl_->file.finish();
  return Done{};
}

Outcome ExrWriter::finish() {
  impl_->exr.reset();
  impl_->stream.finish();
  return impl_->file.finish();
}

Outcome ExrWriter::commit() { return impl_->file.commit(); }

float linear_from_display(float display) {
  if (!(display > 0)) return 0;
  return display <= 0.04045f ? display / 12.92f : std::pow((display + 0.055f) / 1.055f, 2.4f);
}

std::array<float, 4> premultiplied_linear(const float* rgba) {
  return {rgba[3] * linear_from_display(rgba[0]), rgba[3] * linear_from_display(rgba[1]), rgba[3] * linear_from_display(rgba[2]), rgba[3]};
}

}  // namespace catena::render
