// SPDX-License-Identifier: MIT
#include "haptics/servo/log/record.h"

#include <bit>
#include <cstring>
#include <string_view>

#include "engine/base/numbers.h"

namespace catena::haptics::log {

// If an assertion fails, the input or output of a tick has changed: add words for it in record.h and raise kVersion. The snapshot of bricks
// is in blocks of its own (format.h).
static_assert(sizeof(ProbeSample) == 88 && sizeof(LinkReport) == 168 && sizeof(WidgetReport) == 96 && sizeof(HapticState) == 3032);

namespace {

constexpr int kPackedWord = 8, kPackedLinkWord = 19, kPackedWidgetWord = 11, kMissedWord = 21;

std::uint64_t bits(double v) noexcept { return std::bit_cast<std::uint64_t>(v); }
double number(std::uint64_t word) noexcept { return std::bit_cast<double>(word); }

template <class... Bytes>
std::uint64_t from_parts(std::uint32_t low, Bytes... bytes) noexcept {
  std::uint64_t word = low;
  int shift = 32;
  ((word |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes)) << shift, shift += 8), ...);
  return word;
}
std::uint8_t byte_of(std::uint64_t word, int k) noexcept { return static_cast<std::uint8_t>(word >> (8 * k)); }

std::uint64_t two_floats(double a, double b) noexcept {
  const auto half = [](double v) { return std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(v))}; };
  return half(a) | half(b) << 32;
}
double one_float(std::uint64_t word, int k) noexcept {
  return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(word >> (32 * k))));
}

struct Put {
  std::uint64_t* at;
  void operator()(double v) noexcept { *at++ = bits(v); }
  void operator()(const Vec3& v) noexcept {
    for (int a = 0; a < 3; ++a) (*this)(v[a]);
  }
  void operator()(const Quat& q) noexcept {
    for (const double v : {q.w, q.x, q.y, q.z}) (*this)(v);
  }
};

struct Take {
  const std::uint64_t* at;
  void operator()(double& v) noexcept { v = number(*at++); }
  void operator()(Vec3& v) noexcept {
    for (int a = 0; a < 3; ++a) (*this)(v[a]);
  }
  void operator()(Quat& q) noexcept {
    for (double* v : {&q.w, &q.x, &q.y, &q.z}) (*this)(*v);
  }
};

void pack_link(const LinkReport& link, std::uint64_t* words) noexcept {
  Put put{words};
  put(link.proxy);
  put(link.force_n);
  for (const double v : {link.residual, link.weight, link.stiffness_n_per_m, link.gap}) put(v);
  put(link.orientation);
  put(link.torque_nm);
  put(link.accounted_j);
  put(link.release_ratio);
  *put.at = from_parts(static_cast<std::uint32_t>(link.evaluations), link.status, link.active, link.released, link.sample_status);
}

bool unpack_link(const std::uint64_t* words, LinkReport& link) noexcept {
  Take take{words};
  take(link.proxy);
  take(link.force_n);
  for (double* v : {&link.residual, &link.weight, &link.stiffness_n_per_m, &link.gap}) take(*v);
  take(link.orientation);
  take(link.torque_nm);
  take(link.accounted_j);
  take(link.release_ratio);
  const std::uint64_t packed = *take.at;
  link.evaluations = static_cast<std::int32_t>(static_cast<std::uint32_t>(packed));
  link.status = static_cast<LinkStatus>(byte_of(packed, 4));
  link.active = byte_of(packed, 5) == 1;
  link.released = byte_of(packed, 6) == 1;
  link.sample_status = static_cast<SampleStatus>(byte_of(packed, 7));
  link.curve = kUnknownCurve;
  return byte_of(packed, 4) <= static_cast<std::uint8_t>(LinkStatus::coarse) && byte_of(packed, 5) <= 1 && byte_of(packed, 6) <= 1 &&
         byte_of(packed, 7) <= static_cast<std::uint8_t>(SampleStatus::parallel);
}

void pack_widget(const WidgetReport& widget, std::uint64_t* words) noexcept {
  Put put{words};
  for (const Vec3& point : widget.pose.points) put(point);
  put(widget.pose.orientation);
  put(widget.value);
  *put.at = from_parts(widget.revision, widget.mode, widget.handle, widget.active_planes);
}

bool unpack_widget(const std::uint64_t* words, WidgetReport& widget) noexcept {
  Take take{words};
  for (Vec3& point : widget.pose.points) take(point);
  take(widget.pose.orientation);
  take(widget.value);
  const std::uint64_t packed = *take.at;
  widget.revision = static_cast<std::uint32_t>(packed);
  widget.mode = static_cast<WidgetMode>(byte_of(packed, 4));
  widget.handle = static_cast<std::int8_t>(byte_of(packed, 5));
  widget.active_planes = byte_of(packed, 6);
  return byte_of(packed, 4) <= static_cast<std::uint8_t>(WidgetMode::drag) && widget.handle >= -1 && widget.handle <= 6 &&
         widget.active_planes <= 7 && byte_of(packed, 7) == 0;
}

}  // namespace

int pack_tick(const ProbeSample& input, const HapticState& output, std::uint64_t* words) noexcept {
  Put put{words};
  put(input.t_s);
  put(input.position);
  put(input.orientation);
  *put.at++ = from_parts(input.buttons, input.condition, input.forces_on, output.force_state, static_cast<std::int8_t>(output.mode));
  put(output.t_s);
  put(output.force_n);
  put(output.coupling_force_n);
  put(output.torque_nm);
  put(output.energy_j);
  put(output.dissipated_j);
  *put.at++ = output.missed_deadlines;
  *put.at++ = two_floats(output.period_us, output.compute_us);
  *put.at++ = two_floats(output.device_us, 0);
  for (int i = 0; i < output.link_count; ++i) pack_link(output.links[static_cast<std::size_t>(i)], words + kTickWords + kLinkWords * i);
  std::uint64_t* const widgets = words + kTickWords + kLinkWords * output.link_count;
  for (int i = 0; i < output.widget_count; ++i) pack_widget(output.widgets[static_cast<std::size_t>(i)], widgets + kWidgetWords * i);
  return record_word_count(record_layout(output));
}

bool unpack_tick(const RecordWords& words, const RecordLayout& shape, LogTick& tick) noexcept {
  ProbeSample& input = tick.input;
  HapticState& output = tick.output;
  Take take{words.data()};
  take(input.t_s);
  take(input.position);
  take(input.orientation);
  const std::uint64_t packed = *take.at++;
  input.buttons = static_cast<std::uint32_t>(packed);
  input.condition = static_cast<TickCondition>(byte_of(packed, 4));
  input.forces_on = byte_of(packed, 5) == 1;
  output.force_state = static_cast<ForceState>(byte_of(packed, 6));
  output.mode = static_cast<std::int8_t>(byte_of(packed, 7));
  take(output.t_s);
  take(output.force_n);
  take(output.coupling_force_n);
  take(output.torque_nm);
  take(output.energy_j);
  take(output.dissipated_j);
  output.missed_deadlines = *take.at++;
  output.period_us = one_float(*take.at, 0);
  output.compute_us = one_float(*take.at++, 1);
  output.device_us = one_float(*take.at, 0);
  output.probe = input.position;
  output.orientation = input.orientation;
  output.buttons = input.buttons;
  output.condition = input.condition;
  output.link_count = shape.links;
  output.widget_count = shape.widgets;
  bool good = byte_of(packed, 4) <= static_cast<std::uint8_t>(TickCondition::watchdog) && byte_of(packed, 5) <= 1 &&
              byte_of(packed, 6) <= static_cast<std::uint8_t>(ForceState::stopped) && output.mode >= -1 && output.mode < kMaxModes;
  for (int i = 0; i < shape.links; ++i)
    good = unpack_link(words.data() + kTickWords + kLinkWords * i, output.links[static_cast<std::size_t>(i)]) && good;
  const std::uint64_t* const widgets = words.data() + kTickWords + kLinkWords * shape.links;
  for (int i = 0; i < shape.widgets; ++i)
    good = unpack_widget(widgets + kWidgetWords * i, output.widgets[static_cast<std::size_t>(i)]) && good;
  return good;
}

namespace {

constexpr std::string_view kTickNames[kTickWords] = {"probe time",
                                                     "probe_x",
                                                     "probe_y",
                                                     "probe_z",
                                                     "orientation_w",
                                                     "orientation_x",
                                                     "orientation_y",
                                                     "orientation_z",
                                                     "",
                                                     "t",
                                                     "force_x",
                                                     "force_y",
                                                     "force_z",
                                                     "coupling_x",
                                                     "coupling_y",
                                                     "coupling_z",
                                                     "torque_x",
                                                     "torque_y",
                                                     "torque_z",
                                                     "energy",
                                                     "dissipated",
                                                     "",
                                                     "",
                                                     ""};
constexpr std::string_view kLinkNames[kLinkWords] = {"x",
                                                     "y",
                                                     "z",
                                                     "force_x",
                                                     "force_y",
                                                     "force_z",
                                                     "residual",
                                                     "weight",
                                                     "stiffness",
                                                     "gap",
                                                     "orientation_w",
                                                     "orientation_x",
                                                     "orientation_y",
                                                     "orientation_z",
                                                     "torque_x",
                                                     "torque_y",
                                                     "torque_z",
                                                     "accounted",
                                                     "release_ratio",
                                                     ""};

constexpr std::string_view kWidgetNames[kWidgetWords] = {"x", "y", "z", "x2", "y2", "z2", "qw", "qx", "qy", "qz", "value", ""};

std::string difference_text(const std::string& what, const std::string& recorded, const std::string& replayed) {
  return what + " recorded " + recorded + ", replayed " + replayed;
}

std::string packed_difference(std::uint64_t a, std::uint64_t b) {
  const auto forces = [](std::uint64_t w) -> std::string { return to_string(static_cast<ForceState>(byte_of(w, 6))); };
  const auto mode = [](std::uint64_t w) { return std::to_string(static_cast<std::int8_t>(byte_of(w, 7))); };
  if (byte_of(a, 6) != byte_of(b, 6)) return difference_text("force_state", forces(a), forces(b));
  if (byte_of(a, 7) != byte_of(b, 7)) return difference_text("mode", mode(a), mode(b));
  return "the probe's buttons or condition differ";
}

std::string packed_link_difference(const std::string& link, std::uint64_t a, std::uint64_t b) {
  const auto evaluations = [](std::uint64_t w) { return std::to_string(static_cast<std::int32_t>(static_cast<std::uint32_t>(w))); };
  const auto status = [](std::uint64_t w) -> std::string { return to_string(static_cast<LinkStatus>(byte_of(w, 4))); };
  if (byte_of(a, 4) != byte_of(b, 4)) return difference_text(link + "_status", status(a), status(b));
  if (byte_of(a, 5) != byte_of(b, 5))
    return difference_text(link + "_active", std::to_string(byte_of(a, 5)), std::to_string(byte_of(b, 5)));
  if (byte_of(a, 6) != byte_of(b, 6))
    return difference_text(link + "_released", std::to_string(byte_of(a, 6)), std::to_string(byte_of(b, 6)));
  const auto reason = [](std::uint64_t w) -> std::string { return to_string(static_cast<SampleStatus>(byte_of(w, 7))); };
  if (byte_of(a, 7) != byte_of(b, 7) && byte_of(a, 7) != 0) return difference_text(link + "_reason", reason(a), reason(b));
  return difference_text(link + "_evaluations", evaluations(a), evaluations(b));
}

/// Compares packed links; recordings of older versions have no reasons.
bool same_packed_link(std::uint64_t recorded, std::uint64_t replayed) {
  const std::uint64_t all_but_reason = ~std::uint64_t{0} >> 8;
  return recorded == replayed || (byte_of(recorded, 7) == 0 && ((recorded ^ replayed) & all_but_reason) == 0);
}

std::string packed_widget_difference(const std::string& widget, std::uint64_t a, std::uint64_t b) {
  const auto mode = [](std::uint64_t w) -> std::string { return to_string(static_cast<WidgetMode>(byte_of(w, 4))); };
  const auto revision = [](std::uint64_t w) { return std::to_string(static_cast<std::uint32_t>(w)); };
  if (byte_of(a, 4) != byte_of(b, 4)) return difference_text(widget + "_mode", mode(a), mode(b));
  if (static_cast<std::uint32_t>(a) != static_cast<std::uint32_t>(b))
    return difference_text(widget + "_revision", revision(a), revision(b));
  if (byte_of(a, 5) != byte_of(b, 5))
    return difference_text(widget + "_handle", std::to_string(static_cast<std::int8_t>(byte_of(a, 5))),
                           std::to_string(static_cast<std::int8_t>(byte_of(b, 5))));
  return difference_text(widget + "_held", std::to_string(byte_of(a, 6)), std::to_string(byte_of(b, 6)));
}

}  // namespace

std::string first_difference(const RecordWords& recorded, const RecordWords& replayed, const std::vector<std::string>& link_names,
                             const std::vector<std::string>& widget_names) {
  const auto numbers = [&](const std::string& what, std::size_t k) {
    return difference_text(what, to_text(number(recorded[k])), to_text(number(replayed[k])));
  };
  for (std::size_t k = 0; k < kMissedWord; ++k) {
    if (recorded[k] == replayed[k]) continue;
    return k == kPackedWord ? packed_difference(recorded[k], replayed[k]) : numbers(std::string(kTickNames[k]), k);
  }
  for (std::size_t i = 0; i < link_names.size(); ++i)
    for (std::size_t w = 0; w < kLinkWords; ++w) {
      const std::size_t k = kTickWords + kLinkWords * i + w;
      if (recorded[k] == replayed[k] || (w == kPackedLinkWord && same_packed_link(recorded[k], replayed[k]))) continue;
      if (w == kPackedLinkWord) return packed_link_difference(link_names[i], recorded[k], replayed[k]);
      return numbers(link_names[i] + "_" + std::string(kLinkNames[w]), k);
    }
  for (std::size_t i = 0; i < widget_names.size(); ++i)
    for (std::size_t w = 0; w < kWidgetWords; ++w) {
      const std::size_t k = kTickWords + kLinkWords * link_names.size() + kWidgetWords * i + w;
      if (recorded[k] == replayed[k]) continue;
      if (w == kPackedWidgetWord) return packed_widget_difference(widget_names[i], recorded[k], replayed[k]);
      return numbers(widget_names[i] + "_" + std::string(kWidgetNames[w]), k);
    }
  return {};
}

void compress_record(std::span<const std::uint64_t> words, RecordWords& before, std::string& out) {
  const std::size_t mask_at = out.size();
  out.append((words.size() + 7) / 8, '\0');
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == before[k]) continue;
    out[mask_at + k / 8] = static_cast<char>(out[mask_at + k / 8] | static_cast<char>(1u << (k % 8)));
    out.append(reinterpret_cast<const char*>(&words[k]), sizeof words[k]);
    before[k] = words[k];
  }
}

std::size_t decompress_record(std::string_view bytes, int count, RecordWords& words) noexcept {
  const auto n = static_cast<std::size_t>(count);
  std::size_t at = (n + 7) / 8;
  if (bytes.size() < at) return 0;
  for (std::size_t k = 0; k < 8 * ((n + 7) / 8); ++k) {
    if ((static_cast<unsigned char>(bytes[k / 8]) >> (k % 8) & 1) == 0) continue;
    if (k >= n || bytes.size() - at < sizeof(std::uint64_t)) return 0;
    std::memcpy(&words[k], bytes.data() + at, sizeof(std::uint64_t));
    at += sizeof(std::uint64_t);
  }
  return at;
}

}  // namespace catena::haptics::log
