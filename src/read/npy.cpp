// A file is a mark, a version, the length of its head, the head, and the numbers. The head is a dictionary in the letters of
// Python: {'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }.
#include "read/npy.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

namespace {

constexpr const char* convert = "in Python: numpy.save(\"out.npy\", numpy.ascontiguousarray(A, dtype=\"<f8\"))";
constexpr std::size_t most_axes = 2;

struct Head {
  std::optional<std::string_view> descr, order;
  std::optional<std::vector<std::size_t>> shape;
};

/// The head, letter by letter.
class HeadParser {
 public:
  HeadParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Head parse() {
    Head head;
    expect('{');
    while (!next_is('}')) {
      const std::string_view key = quoted();
      expect(':');
      if (key == "descr" && !head.descr)
        head.descr = descr();
      else if (key == "fortran_order" && !head.order)
        head.order = word();
      else if (key == "shape" && !head.shape)
        head.shape = shape();
      else
        fail(fmt::format("{} has no place there, or stands there twice", base::in_quotes(key)));
      if (!next_is(',')) {
        expect('}');
        break;
      }
    }
    skip_blanks();
    if (at_ < text_.size()) fail("more follows behind its closing bracket");
    if (!head.descr || !head.order || !head.shape) fail("it must have \"descr\", \"fortran_order\" and \"shape\"");
    return head;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw GridFileError(fmt::format("{} is damaged: its head, at byte {}: {}", name_, at_ + 1, what), convert);
  }
  void skip_blanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  bool next_is(char letter) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != letter) return false;
    ++at_;
    return true;
  }
  void expect(char letter) {
    if (!next_is(letter)) fail(fmt::format("'{}' must stand here", letter));
  }
  std::string_view quoted() {
    skip_blanks();
    const char mark = at_ < text_.size() ? text_[at_] : ' ';
    const std::size_t end = mark == '\'' || mark == '"' ? text_.find(mark, at_ + 1) : std::string_view::npos;
    if (end == std::string_view::npos) fail("a word in quotation marks must stand here");
    const std::string_view inner = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    return inner;
  }
  std::string_view descr() {
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == '[')
      throw GridFileError(fmt::format("{} has columns with names and types of their own (a structured array)", name_),
                          "in Python: numpy.lib.recfunctions.structured_to_unstructured(A) makes a plain one");
    return quoted();
  }
  std::string_view word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_]))) ++at_;
    const std::string_view found = text_.substr(begin, at_ - begin);
    if (found != "True" && found != "False") fail("True or False must stand here");
    return found;
  }
  std::vector<std::size_t> shape() {
    std::vector<std::size_t> lengths;
    expect('(');
    while (!next_is(')')) {
      skip_blanks();
      const std::size_t begin = at_;
      while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) ++at_;
      const auto length = base::read_number<std::size_t>(text_.substr(begin, at_ - begin));
      if (!length) fail("a length of the array must stand here, a whole number below 2^64");
      lengths.push_back(*length);
      if (lengths.size() > 32) fail("an array has at most 32 axes");
      if (!next_is(',')) {
        expect(')');
        break;
      }
    }
    return lengths;
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// The head of a file, and where its numbers begin.
std::string_view head_of(std::string_view bytes, const std::string& name, std::size_t& begin) {
  const auto damaged = [&](const char* what) {
    throw GridFileError(fmt::format("{} is damaged: {}", name, what), "save it again with numpy.save");
  };
  const std::size_t version_at = npy_mark.size();
  if (bytes.size() < version_at + 4) damaged("it ends before its head");
  const auto byte = [&](std::size_t at) { return std::size_t{static_cast<unsigned char>(bytes[at])}; };
  const std::size_t version = byte(version_at);
  if (version < 1 || version > 3)
    throw GridFileError(fmt::format("{} has version {} of NumPy's format; 1 to 3 are known", name, version), convert);
  const std::size_t length_bytes = version == 1 ? 2 : 4;
  begin = version_at + 2 + length_bytes;
  if (bytes.size() < begin) damaged("it ends before its head");
  std::size_t length = 0;
  for (std::size_t k = length_bytes; k-- > 0;) length = length << 8 | byte(version_at + 2 + k);
  if (length > bytes.size() - begin) damaged("its head is longer than the file");
  const std::string_view head = bytes.substr(begin, length);
  begin += length;
  return head;
}

void check_type(std::string_view descr, const std::string& name) {
  if (descr == "<f8" || descr == "<f4") return;
  throw GridFileError(fmt::format("{} has numbers of the type {}; \"<f8\" and \"<f4\" are read (Float64 and Float32, "
                                  "little-endian)",
                                  name, base::in_quotes(descr)),
                      convert);
}

/// a b, or nothing if no std::size_t holds it.
std::optional<std::size_t> product(std::size_t a, std::size_t b) {
  if (a != 0 && b > std::numeric_limits<std::size_t>::max() / a) return std::nullopt;
  return a * b;
}

template <class Number>
void copy(const char* from, std::size_t step, std::size_t count, double* to, std::size_t stride) {
  static_assert(std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < count; ++i) {
    Number number;
    std::memcpy(&number, from + i * step * sizeof number, sizeof number);
    to[i * stride] = double(number);
  }
}

}  // namespace

void NpyArray::copy_column(std::size_t column, double* to, std::size_t stride) const {
  const std::size_t first = column_after_column ? column * rows : column, step = column_after_column ? 1 : columns;
  if (single)
    copy<float>(numbers.data() + first * sizeof(float), step, rows, to, stride);
  else
    copy<double>(numbers.data() + first * sizeof(double), step, rows, to, stride);
}

NpyArray parse_npy(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, npy_mark.size()) != npy_mark)
    throw GridFileError(fmt::format("{} is no array that NumPy has saved", name), convert);
  std::size_t begin = 0;
  const std::string_view text = head_of(bytes, name, begin);
  const Head head = HeadParser(text, name).parse();
  check_type(*head.descr, name);
  NpyArray array;
  array.single = *head.descr == "<f4";
  array.column_after_column = *head.order == "True";
  const std::vector<std::size_t>& shape = *head.shape;
  if (shape.empty() || shape.size() > most_axes)
    throw GridFileError(fmt::format("{} has {} axes; a table has two, rows and columns, or one", name, shape.size()),
                        "in Python: A.reshape(-1, A.shape[-1])");
  array.rows = shape[0];
  if (shape.size() > 1) array.columns = shape[1];
  const auto count = product(array.rows, array.columns);
  const auto needed = count ? product(*count, array.single ? sizeof(float) : sizeof(double)) : std::nullopt;
  array.numbers = bytes.substr(begin);
  if (!needed || *needed != array.numbers.size())
    throw GridFileError(
        fmt::format("{} is damaged: its head tells of {} x {} numbers, {}, and {} bytes follow", name, array.rows,
                    array.columns, needed ? fmt::format("{} bytes", *needed) : std::string("more than there can be"),
                    array.numbers.size()),
        "save it again with numpy.save, one array in a file");
  return array;
}

}  // namespace gaussdrift::read
