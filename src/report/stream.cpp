#include "report/stream.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "gaussdrift/error.hpp"

namespace gaussdrift::report {

namespace {

/// What is expected of the level i, from those before it; modulo 65536.
std::uint16_t expected(const std::vector<std::uint16_t>& level, std::size_t i, std::size_t along) {
  switch (i % along) {
    case 0:
      return i == 0 ? 0 : level[i - along];
    case 1:
      return level[i - 1];
    default:
      return static_cast<std::uint16_t>(2 * level[i - 1] - level[i - 2]);
  }
}

/// Small differences of either sign as small numbers.
std::uint16_t zigzag(std::uint16_t difference) {
  return static_cast<std::uint16_t>(difference << 1 ^ (difference & 0x8000 ? 0xffff : 0));
}

std::uint16_t unzigzag(std::uint16_t number) {
  return static_cast<std::uint16_t>(number >> 1 ^ (number & 1 ? 0xffff : 0));
}

std::string deflated(const std::vector<unsigned char>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  constexpr int level = 6;  // of zlib
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, bytes.data(), bytes.size(), level) != Z_OK)
    throw std::bad_alloc();  // the only way in which it can fail
  packed.resize(size);
  return packed;
}

std::string coded(const std::vector<std::uint16_t>& level, std::size_t along) {
  std::vector<unsigned char> bytes(2 * level.size());
  for (std::size_t i = 0; i < level.size(); ++i) {
    const std::uint16_t code = zigzag(static_cast<std::uint16_t>(level[i] - expected(level, i, along)));
    bytes[i] = static_cast<unsigned char>(code & 0xff);
    bytes[level.size() + i] = static_cast<unsigned char>(code >> 8);
  }
  return deflated(bytes);
}

}  // namespace

Stream stream_of(std::string name, std::uint32_t every, std::array<std::uint32_t, 3> shape,
                 const std::vector<double>& values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values)
    if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  Stream stream{std::move(name), every, shape, 0, 0, {}};
  if (low <= high) stream.min = low, stream.max = high;
  const double half = stream.max / 2 - stream.min / 2;  // the whole may be too large a number
  std::vector<std::uint16_t> level(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::isfinite(values[i])) {
      const double place = half > 0 ? (values[i] / 2 - stream.min / 2) / half : 0;
      level[i] = static_cast<std::uint16_t>(1 + std::lround(place * levels_between_ends));
    }
  stream.bytes = coded(level, shape[0]);
  return stream;
}

std::vector<std::uint16_t> levels_of(const Stream& stream) {
  const std::size_t size = stream.size();
  std::vector<unsigned char> bytes(2 * size);
  uLongf found = bytes.size();
  if (uncompress(bytes.data(), &found, reinterpret_cast<const Bytef*>(stream.bytes.data()), stream.bytes.size()) !=
          Z_OK ||
      found != bytes.size())
    throw FileError(fmt::format("the numbers of {} are damaged", stream.name));
  std::vector<std::uint16_t> level(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto code = static_cast<std::uint16_t>(bytes[i] | bytes[size + i] << 8);
    level[i] = static_cast<std::uint16_t>(expected(level, i, stream.shape[0]) + unzigzag(code));
  }
  return level;
}

std::vector<double> values_of(const Stream& stream) {
  std::vector<double> values;
  values.reserve(stream.size());
  for (const std::uint16_t level : levels_of(stream)) {
    const double s = (level - 1) / levels_between_ends;
    values.push_back(level == 0 ? std::numeric_limits<double>::quiet_NaN() : (1 - s) * stream.min + s * stream.max);
  }
  return values;
}

Stream coarser(const Stream& stream) {
  const std::vector<std::uint16_t> all = levels_of(stream);
  Stream half{stream.name, 2 * stream.every, {}, stream.min, stream.max, {}};
  for (std::size_t k = 0; k < 3; ++k) half.shape[k] = (stream.shape[k] + 1) / 2;
  std::vector<std::uint16_t> level;
  level.reserve(half.size());
  for (std::size_t z = 0; z < stream.shape[2]; z += 2)
    for (std::size_t y = 0; y < stream.shape[1]; y += 2)
      for (std::size_t x = 0; x < stream.shape[0]; x += 2)
        level.push_back(all[(z * stream.shape[1] + y) * stream.shape[0] + x]);
  half.bytes = coded(level, half.shape[0]);
  return half;
}

}  // namespace gaussdrift::report
