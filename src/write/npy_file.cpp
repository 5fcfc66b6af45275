#include "write/npy_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <string>

#include "write/draining.hpp"

namespace gaussdrift::write {

namespace {

static_assert(std::endian::native == std::endian::little, "files say that they are little-endian");

std::string head_of(const std::vector<std::size_t>& shape) {
  constexpr std::size_t before = 10, unit = 64;  // mark, version and length; numbers begin at a multiple of 64 bytes
  std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': True, 'shape': ({}{}), }}", fmt::join(shape, ", "),
                                 shape.size() == 1 ? "," : "");
  const std::size_t whole = (before + text.size() + 1 + unit - 1) / unit * unit;
  text.resize(whole - before - 1, ' ');
  text += '\n';
  return std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(text.size() & 0xFF) +
         static_cast<char>(text.size() >> 8) + text;
}

}  // namespace

void write_npy(std::FILE* out, const std::vector<std::size_t>& shape, const double* values) {
  std::size_t count = 1;
  for (const std::size_t length : shape) count *= length;
  write_bytes(out, head_of(shape));
  write_bytes(out, {reinterpret_cast<const char*>(values), count * sizeof(double)});
  flush(out);
}

}  // namespace gaussdrift::write
