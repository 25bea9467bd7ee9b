// SPDX-License-Identifier: MIT
/// Protocol between volume_peers.py and a compared program (a "peer"), for peers in C++:   PEER CASE.json
///
/// CASE.json: "raw": a file of float32 in the same folder, x fastest, voxel (i, j, k) at position (i, j, k); "dims": [nx, ny, nz];
/// "colour": [[value, r, g, b], ...] and "opacity": [[value, alpha], ...], linear between points and constant beyond them, with alpha per
/// "unit" voxels; "shade": by the gradient, ambient 0.2, two-sided diffuse 0.7, white specular 0.2 with power 20, a headlight;
/// "view": {"elevation" and "fovy_deg" in degrees, "distance" in longest sides} around the centre of the box, z up, from -y at azimuth 0,
/// from +x at 90; "size": [width, height].
/// Requests are lines on standard input: {"mode": "...", "azimuths": [degrees, ...], "picture": "path.npy", "warm": 1}. The peer
/// draws `warm` images (default 1) that are not timed, then one per azimuth, saves the last as bytes [height, width, 4], red, green, blue
/// over black and alpha, row 0 at the top, rays through the pixels' centres, and replies with a line
/// {"cpu_ms": [...], "wall_ms": [...], "picture": path, "note": "..."}, one number per azimuth, or {"error": "message"}.
/// The setup of a mode is done before the warm images and not timed. One thread.
#pragma once
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/json.h"
#include "engine/base/json_text.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"

namespace catena::peers {

struct Case {
  std::vector<float> values;
  std::array<int, 3> dims{};
  std::vector<std::vector<double>> color, opacity;
  double unit = 1;
  bool is_shaded = false;
  double elevation_deg = 20, distance = 2.7, fovy_deg = 30;
  int width = 1024, height = 768;

  Vec3 center() const { return 0.5 * Vec3(dims[0] - 1, dims[1] - 1, dims[2] - 1); }
  Vec3 camera_position(double azimuth_deg) const {
    constexpr double kRadian = 3.14159265358979323846 / 180;
    const double a = azimuth_deg * kRadian, e = elevation_deg * kRadian;
    const double far = distance * std::max({dims[0], dims[1], dims[2]});
    return center() + far * Vec3(std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e));
  }
  /// Extinction per voxel length, from linearly interpolated opacity.
  double extinction(double value) const {
    std::size_t i = 0;
    while (i < opacity.size() && opacity[i][0] <= value) ++i;
    double alpha = i == 0 ? opacity.front()[1] : opacity.back()[1];
    if (i > 0 && i < opacity.size())
      alpha = std::lerp(opacity[i - 1][1], opacity[i][1], (value - opacity[i - 1][0]) / (opacity[i][0] - opacity[i - 1][0]));
    return -std::log1p(-std::min(alpha, 0.99999)) / unit;
  }
};

inline Result<Case> read_case(const std::string& path) {
  CATENA_TRY(const json::Node node, json::read(path));
  Case out;
  CATENA_TRY(const std::string raw, json::require_string(node, "raw"));
  CATENA_TRY(const Vec3 dims, json::require_vec3(node, "dims"));
  for (int a = 0; a < 3; ++a) out.dims[std::size_t(a)] = int(dims[a]);
  CATENA_TRY(out.color, json::as_rows(json::member_or_parent(node, "colour"), "colour", 4));
  CATENA_TRY(out.opacity, json::as_rows(json::member_or_parent(node, "opacity"), "opacity", 2));
  CATENA_TRY(out.unit, json::require_number(node, "unit", json::NumberRange::positive));
  CATENA_TRY(out.is_shaded, json::get_boolean(node, "shade", false));
  const json::Node& view = json::member_or_parent(node, "view");
  CATENA_TRY(out.elevation_deg, json::require_number(view, "elevation"));
  CATENA_TRY(out.distance, json::require_number(view, "distance", json::NumberRange::positive));
  CATENA_TRY(out.fovy_deg, json::get_number(view, "fovy_deg", 30, json::NumberRange::positive));
  const json::Node* size = node.find("size");
  if (!size || size->items.size() != 2) return json::error_at(json::member_or_parent(node, "size"), "expected \"size\": [width, height]");
  out.width = int(size->items[0].number);
  out.height = int(size->items[1].number);
  if (out.color.empty() || out.opacity.empty()) return json::error_at(node, "expected points of \"colour\" and \"opacity\"");
  const std::string file = (std::filesystem::path(path).parent_path() / raw).string();
  out.values.resize(std::size_t(out.dims[0]) * std::size_t(out.dims[1]) * std::size_t(out.dims[2]));
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(out.values.data()), std::streamsize(out.values.size() * sizeof(float)));
  if (!in) return Error{fmt::format("{}: expected {} floats", file, out.values.size())};
  return out;
}

class Baseline {
 public:
  virtual ~Baseline() = default;
  /// Called when the mode changes, with the azimuth of the saved image.
  virtual Outcome set_mode(const std::string& mode, double azimuth_deg) = 0;
  /// Draws an image; returns when it is finished.
  virtual Outcome draw(double azimuth_deg) = 0;
  /// The last image, in the protocol's format.
  virtual Result<std::vector<std::uint8_t>> read_image() = 0;
  /// Description of the mode's settings; may be empty.
  virtual std::string note() { return {}; }
};

inline Outcome write_npy(const std::string& path, const std::vector<std::uint8_t>& rgba, int width, int height) {
  std::string header = fmt::format("{{'descr': '|u1', 'fortran_order': False, 'shape': ({}, {}, 4), }}", height, width);
  header.resize((header.size() + 10 + 1 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  std::ofstream out(path, std::ios::binary);
  out << "\x93NUMPY\x01" << '\0' << char(header.size() & 255) << char(header.size() >> 8) << header;
  out.write(reinterpret_cast<const char*>(rgba.data()), std::streamsize(rgba.size()));
  if (!out) return Error{path + ": cannot be written"};
  return Done{};
}

/// Handles one request; `mode` is that of the previous request.
inline Result<std::string> handle_request(Baseline& peer, const Case& given, const std::string& line, std::string& mode) {
  CATENA_TRY(const json::Node request, json::parse(line, "request"));
  CATENA_TRY(const std::string wanted, json::require_string(request, "mode"));
  CATENA_TRY(const std::string path, json::require_string(request, "picture"));
  CATENA_TRY(const int warm, json::get_integer(request, "warm", 1, 0, 100));
  std::vector<double> azimuths, cpu, wall;
  for (const json::Node& node : json::member_or_parent(request, "azimuths").items) azimuths.push_back(node.number);
  if (azimuths.empty()) return json::error_at(request, "expected \"azimuths\": [degrees, ...]");
  if (wanted != mode) {
    mode.clear();
    CATENA_CHECK(peer.set_mode(wanted, azimuths.back()));
    mode = wanted;
  }
  for (int i = 0; i < warm; ++i) CATENA_CHECK(peer.draw(azimuths.front() - 3));
  for (const double azimuth : azimuths) {
    const std::int64_t start = now_ns(), used = process_cpu_ns();
    CATENA_CHECK(peer.draw(azimuth));
    wall.push_back(ms_since(start));
    cpu.push_back(1e-6 * double(process_cpu_ns() - used));
  }
  CATENA_TRY(const std::vector<std::uint8_t> rgba, peer.read_image());
  CATENA_CHECK(write_npy(path, rgba, given.width, given.height));
  return fmt::format("{{\"cpu_ms\": [{:.3f}], \"wall_ms\": [{:.3f}], \"picture\": {}, \"note\": {}}}", fmt::join(cpu, ", "),
                     fmt::join(wall, ", "), json_string(path), json_string(peer.note()));
}

/// Main function of a peer. `make` may keep a reference to the case.
inline int run_baseline(int argc, char** argv, const std::function<Result<std::unique_ptr<Baseline>>(const Case&)>& make) {
  const auto failed = [](const std::string& message) {
    fmt::print(stderr, "{}\n", message);
    return 2;
  };
  if (argc != 2) return failed(fmt::format("usage: {} CASE.json", argv[0]));
  const auto given = read_case(argv[1]);
  if (!given) return failed(given.error().message);
  const auto peer = make(*given);
  if (!peer) return failed(peer.error().message);
  std::string mode;
  for (std::string line; std::getline(std::cin, line);) {
    const auto answered = handle_request(**peer, *given, line, mode);
    fmt::print("{}\n", answered ? *answered : fmt::format("{{\"error\": {}}}", json_string(answered.error().message)));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace catena::peers
