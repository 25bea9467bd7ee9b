// SPDX-License-Identifier: MIT
/// Small stores written for the tests, by the libraries that other programs use.
#pragma once
#include <blosc.h>
#include <hdf5.h>
#include <libdeflate.h>
#include <lz4.h>
#include <tiffio.h>
#include <zstd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tests/support/support.h"

namespace catena::stores_test {

/// A volume of 16-bit integers; value(x, y, z) differs from voxel to voxel.
struct Volume {
  int x = 70, y = 50, z = 40;
  static std::uint16_t value(int i, int j, int k) { return static_cast<std::uint16_t>(i + 131 * j + 1009 * k); }
};

/// Compresses bytes as numcodecs does.
inline std::string compress(const std::string& codec, const std::string& in) {
  std::string out(2 * in.size() + 1000, '\0');
  std::size_t bytes = in.size();
  if (codec == "zlib" || codec == "gzip") {
    const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> deflate(::libdeflate_alloc_compressor(1),
                                                                                           ::libdeflate_free_compressor);
    const std::size_t half = in.size() / 2;  // two members
    if (codec == "zlib") return out.substr(0, ::libdeflate_zlib_compress(deflate.get(), in.data(), in.size(), out.data(), out.size()));
    bytes = ::libdeflate_gzip_compress(deflate.get(), in.data(), half, out.data(), out.size());
    bytes += ::libdeflate_gzip_compress(deflate.get(), in.data() + half, in.size() - half, out.data() + bytes, out.size() - bytes);
  } else if (codec == "zstd") {
    bytes = ::ZSTD_compress(out.data(), out.size(), in.data(), in.size(), 1);
  } else if (codec == "lz4") {
    const auto size = static_cast<std::uint32_t>(in.size());
    std::memcpy(out.data(), &size, sizeof size);
    bytes = 4 + static_cast<std::size_t>(
                    ::LZ4_compress_default(in.data(), out.data() + 4, static_cast<int>(in.size()), static_cast<int>(out.size() - 4)));
  } else if (codec == "blosc") {
    bytes = static_cast<std::size_t>(::blosc_compress_ctx(5, 1, 2, in.size(), in.data(), out.data(), out.size(), "lz4", 0, 1));
  } else {
    return in;
  }
  return out.substr(0, bytes);
}

/// Layout of a Zarr array.
struct ZarrOptions {
  std::string codec = "blosc", type = "<u2", separator = ".";
  bool fortran = false;
  int edge = 32;
  std::string missing{};  ///< Key of a chunk that is not written.
};

inline std::string zarray(const Volume& v, const ZarrOptions& o) {
  const std::string compressor = o.codec == "none" ? "null" : "{\"id\": \"" + o.codec + "\"}";
  return fmt::format(R"({{"zarr_format": 2, "shape": [{}, {}, {}], "chunks": [{}, {}, {}], "dtype": "{}", "order": "{}", "compressor": {},
"filters": null, "fill_value": 7, "dimension_separator": "{}"}})",
                     v.z, v.y, v.x, o.edge, o.edge, o.edge, o.type, o.fortran ? "F" : "C", compressor, o.separator);
}

/// Writes an array, every `step`-th voxel of the volume.
inline void write_zarr(const std::string& folder, const Volume& v, const ZarrOptions& o, int step = 1) {
  std::filesystem::create_directories(folder);
  test::write_file(folder + "/.zarray", zarray(v, o));
  const int e = o.edge;
  for (int cz = 0; cz * e < v.z; ++cz)
    for (int cy = 0; cy * e < v.y; ++cy)
      for (int cx = 0; cx * e < v.x; ++cx) {
        std::string bytes(static_cast<std::size_t>(e * e * e) * 2, '\0');
        for (int n = 0; n < e * e * e; ++n) {
          int at[3] = {n % e, n / e % e, n / e / e};
          if (o.fortran) std::swap(at[0], at[2]);
          std::uint16_t value = Volume::value((cx * e + at[0]) * step, (cy * e + at[1]) * step, (cz * e + at[2]) * step);
          if (o.type[0] == '>') value = static_cast<std::uint16_t>(value << 8 | value >> 8);
          std::memcpy(bytes.data() + 2 * n, &value, 2);
        }
        const std::string key = fmt::format("{}{}{}{}{}", cz, o.separator, cy, o.separator, cx);
        if (key == o.missing) continue;
        std::filesystem::create_directories(std::filesystem::path(folder + "/" + key).parent_path());
        test::write_file(folder + "/" + key, compress(o.codec, bytes));
      }
}

/// Writes a pyramid of OME-Zarr 0.4 with an axis of channels left out.
inline void write_ome_zarr(const std::string& folder, int levels) {
  std::filesystem::create_directories(folder);
  test::write_file(folder + "/.zgroup", R"({"zarr_format": 2})");
  std::string datasets;
  for (int level = 0; level < levels; ++level) {
    const int f = 1 << level;
    write_zarr(fmt::format("{}/{}", folder, level), {128 / f, 128 / f, 128 / f}, {}, f);
    datasets += fmt::format(R"({}{{"path": "{}", "coordinateTransformations": [{{"type": "scale", "scale": [{}, {}, {}]}}]}})",
                            level > 0 ? ", " : "", level, f * 0.5, f * 0.5, f * 0.5);
  }
  test::write_file(folder + "/.zattrs",
                   R"({"multiscales": [{"version": "0.4", "axes": [{"name": "z", "unit": "micrometer"},
{"name": "y", "unit": "micrometer"}, {"name": "x", "unit": "micrometer"}], "datasets": [)" +
                       datasets +
                       R"(]}], "omero": {"channels": [{"label": "DAPI", "color": "00FF00", "window": {"start": 5, "end": 900}}]}})");
}

/// Writes a TIFF file, tiled or in strips, a page per slice.
inline void write_tiff(const std::string& path, const Volume& v, bool tiled, const char* mode = "w8", int first = 0) {
  TIFF* tiff = ::TIFFOpen(path.c_str(), mode);
  for (int k = 0; k < v.z; ++k) {
    ::TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, v.x);
    ::TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, v.y);
    ::TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
    ::TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    ::TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    ::TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_LZW);
    const int width = tiled ? 32 : v.x, height = tiled ? 16 : 7;
    if (tiled) {
      ::TIFFSetField(tiff, TIFFTAG_TILEWIDTH, width);
      ::TIFFSetField(tiff, TIFFTAG_TILELENGTH, height);
    } else {
      ::TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, height);
    }
    for (int y = 0; y < v.y; y += height)
      for (int x = 0; x < v.x; x += width) {
        const int rows = tiled ? height : std::min(height, v.y - y);
        std::vector<std::uint16_t> block(static_cast<std::size_t>(width) * static_cast<std::size_t>(rows));
        for (int j = 0; j < rows; ++j)
          for (int i = 0; i < width; ++i) block[static_cast<std::size_t>(j * width + i)] = Volume::value(x + i, y + j, first + k);
        const auto bytes = static_cast<tmsize_t>(2 * block.size());
        const auto column = static_cast<std::uint32_t>(x), row = static_cast<std::uint32_t>(y);
        if (tiled)
          ::TIFFWriteEncodedTile(tiff, ::TIFFComputeTile(tiff, column, row, 0, 0), block.data(), bytes);
        else
          ::TIFFWriteEncodedStrip(tiff, ::TIFFComputeStrip(tiff, row, 0), block.data(), bytes);
      }
    ::TIFFWriteDirectory(tiff);
  }
  ::TIFFClose(tiff);
}

/// Writes an HDF5 file with the data set `name`, in chunks compressed by gzip, or contiguous.
inline void write_hdf5(const std::string& path, const Volume& v, const std::string& name, bool chunked) {
  const hid_t file = ::H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t size[3] = {hsize_t(v.z), hsize_t(v.y), hsize_t(v.x)}, chunk[3] = {16, 16, 32};
  const hid_t space = ::H5Screate_simple(3, size, nullptr), list = ::H5Pcreate(H5P_DATASET_CREATE), links = ::H5Pcreate(H5P_LINK_CREATE);
  ::H5Pset_create_intermediate_group(links, 1);
  if (chunked) {
    ::H5Pset_chunk(list, 3, chunk);
    ::H5Pset_shuffle(list);
    ::H5Pset_deflate(list, 1);
  }
  const hid_t data = ::H5Dcreate2(file, name.c_str(), H5T_STD_U16BE, space, links, list, H5P_DEFAULT);
  std::vector<std::uint16_t> values;
  for (int k = 0; k < v.z; ++k)
    for (int j = 0; j < v.y; ++j)
      for (int i = 0; i < v.x; ++i) values.push_back(Volume::value(i, j, k));
  ::H5Dwrite(data, H5T_NATIVE_UINT16, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  for (const hid_t id : {data, space, list, links, file}) ::H5Idec_ref(id);
}

}  // namespace catena::stores_test
