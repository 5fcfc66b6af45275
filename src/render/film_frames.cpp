#include "render/film_frames.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "base/state_bytes.hpp"
#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift::render {

namespace fs = std::filesystem;

namespace {

/// The bytes of numbers sorted by their place, which makes them alike, and packed.
std::string packed(const std::vector<double>& values) {
  constexpr std::uint32_t lost = 0x7FF;  // of 23 bits
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  std::string sorted(values.size() * sizeof(float), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float value = std::abs(values[i]) < 1e-12 * largest ? 0.F : static_cast<float>(values[i]);
    auto bits = std::bit_cast<std::uint32_t>(value);
    if (std::isfinite(value)) bits = (bits + lost / 2 + 1) & ~lost;
    for (std::size_t byte = 0; byte < sizeof bits; ++byte)
      sorted[byte * values.size() + i] = static_cast<char>(bits >> 8 * byte & 0xFF);
  }
  uLongf size = compressBound(sorted.size());
  std::string bytes(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(sorted.data()),
                sorted.size(), Z_BEST_SPEED) != Z_OK)
    throw std::bad_alloc();
  bytes.resize(size);
  return bytes;
}

std::vector<double> unpacked(const std::string& bytes, std::size_t count) {
  std::string sorted(count * sizeof(float), '\0');
  uLongf size = sorted.size();
  if (uncompress(reinterpret_cast<Bytef*>(sorted.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                 bytes.size()) != Z_OK ||
      size != sorted.size())
    throw std::out_of_range("its numbers are damaged");
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t bits = 0;
    for (std::size_t byte = 0; byte < sizeof bits; ++byte)
      bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(sorted[byte * count + i])) << 8 * byte;
    values[i] = static_cast<double>(std::bit_cast<float>(bits));
  }
  return values;
}

std::uint64_t sum_of(std::string_view bytes) {
  return crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

void pass_head(base::StateBytes& bytes, FilmFrame& frame) {
  Lattice& lattice = frame.density.lattice;
  bytes(frame.time, lattice.dimension, lattice.points, lattice.origin, lattice.spacing, lattice.sphere);
}

class FilmFrames : public Observer {
 public:
  explicit FilmFrames(fs::path folder) : folder_(std::move(folder)) {}
  std::string name() const override { return "animation"; }
  bool needs_particles(double /*elapsed*/) const override { return false; }
  void frame(const Frame& /*frame*/) override {}
  void moment(const Frame& frame) override {
    write::write_text(film_frame_file(folder_, static_cast<std::size_t>(frame.index)),
                      bytes_of({frame.time, *frame.density}),
                      [] { return true; });  // a check sum tells whether the disk has all of it
  }

 private:
  fs::path folder_;
};

}  // namespace

std::string bytes_of(const FilmFrame& frame) {
  base::StateBytes bytes;
  FilmFrame head = frame;
  pass_head(bytes, head);
  std::string rho = packed(frame.density.rho);
  std::uint64_t fields = frame.density.fields.size();
  bytes(rho, fields);
  for (const FieldOnGrid& field : frame.density.fields) {
    std::string name = field.name, values = packed(field.values);
    int components = field.components;
    bytes(name, components, values);
  }
  std::uint64_t sum = sum_of(bytes.written());
  bytes(sum);
  return bytes.written();
}

FilmFrame film_frame_of(const std::string& text) {
  if (text.size() < sizeof(std::uint64_t)) throw std::out_of_range("it is too short");
  const std::string_view all(text), before = all.substr(0, all.size() - sizeof(std::uint64_t));
  base::StateBytes end(all.substr(before.size())), bytes(before);
  std::uint64_t sum = 0, fields = 0;
  end(sum);
  if (sum != sum_of(before)) throw std::out_of_range("its check sum differs");
  FilmFrame frame;
  pass_head(bytes, frame);
  std::string rho;
  bytes(rho, fields);
  const std::size_t points = frame.density.lattice.size();
  frame.density.rho = unpacked(rho, points);
  for (std::uint64_t k = 0; k < fields; ++k) {
    FieldOnGrid field;
    std::string values;
    bytes(field.name, field.components, values);
    field.values = unpacked(values, points * static_cast<std::size_t>(field.components));
    frame.density.fields.push_back(std::move(field));
  }
  bytes.end();
  return frame;
}

fs::path film_frame_file(const fs::path& folder, std::size_t number) {
  return folder / write::checkpoints_folder / "animation" / fmt::format("frame_{:04}.raw", number);
}

FilmFrame read_film_frame(const fs::path& folder, std::size_t number) {
  const fs::path name = film_frame_file(folder, number);
  std::ifstream in(name, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (!in) throw FileError(fmt::format("cannot read {}", name.string()));
  try {
    return film_frame_of(bytes);
  } catch (const std::out_of_range& error) {
    throw FileError(fmt::format("{} is damaged: {}; run the case anew", name.string(), error.what()));
  }
}

void remove_film_frames(const fs::path& folder) {
  if (!write::checkpoint_files(folder).empty()) return;
  std::error_code ignored;
  for (std::size_t i = 0; fs::remove(film_frame_file(folder, i), ignored); ++i) {
  }
  const fs::path inner = film_frame_file(folder, 0).parent_path();
  fs::remove(inner, ignored);  // if it is empty
  fs::remove(inner.parent_path(), ignored);
}

std::unique_ptr<Observer> film_frames(const fs::path& folder) { return std::make_unique<FilmFrames>(folder); }

}  // namespace gaussdrift::render
