#include "read/number_array.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string_view>
#include <type_traits>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

namespace {

static_assert(std::endian::native == std::endian::little || std::endian::native == std::endian::big);

constexpr std::size_t chunk_bytes = 65536;
constexpr std::uint64_t most_by_deflate = 1032;  // bytes out of one byte, of any stream that is valid

std::string shown(std::string_view text) { return base::in_quotes(text, 60); }
std::string shown(const std::string* text) { return text ? shown(std::string_view(*text)) : "nothing"; }

std::string array_name(const Element& array) {
  const std::string* name = array.attribute("Name");
  return shown(name ? std::string_view(*name) : "");
}

[[noreturn]] void fail(const FileBytes& file, const Element& array, std::string_view what, std::string remedy = {}) {
  throw GridFileError(fmt::format("{}: the array {} {}", line_of(file, array), array_name(array), what),
                      std::move(remedy));
}

[[noreturn]] void fail_count(const FileBytes& file, const Element& array, bool more, std::size_t count) {
  fail(file, array, fmt::format("has {} numbers than the {} that are needed", more ? "more" : "fewer", count));
}

[[noreturn]] void fail_damaged(const FileBytes& file, const Element& array, std::string_view what) {
  fail(file, array, fmt::format("is damaged: {}", what));
}

/// Calls work(Number{}) with the number type of a DataArray; false if it has none.
template <class Work>
bool with_type(std::string_view name, const Work& work) {
  const auto is = [&](std::string_view known, auto number) {
    if (name == known) work(number);
    return name == known;
  };
  return is("Float32", float{}) || is("Float64", double{}) || is("Int8", std::int8_t{}) ||
         is("UInt8", std::uint8_t{}) || is("Int16", std::int16_t{}) || is("UInt16", std::uint16_t{}) ||
         is("Int32", std::int32_t{}) || is("UInt32", std::uint32_t{}) || is("Int64", std::int64_t{}) ||
         is("UInt64", std::uint64_t{});
}

std::string_view type_of(const Element& array) {
  const std::string* type = array.attribute("type");
  return type ? std::string_view(*type) : std::string_view{};
}

std::size_t word_bytes(const FileBytes& file, const Element& array) {
  std::size_t bytes = 0;
  if (!with_type(type_of(array), [&](auto number) { bytes = sizeof(number); }))
    fail(file, array, fmt::format("does not hold numbers: its type is {}", shown(array.attribute("type"))));
  return bytes;
}

// ---- text

/// As text may be: a little above the largest number of Float32, as 3.4028235e38 is.
template <class Number>
std::optional<double> as_type(double value) {
  if constexpr (std::is_same_v<Number, double>) {
    return value;
  } else if constexpr (std::is_same_v<Number, float>) {
    constexpr double largest = std::numeric_limits<float>::max(), rounding = 1 + 3e-8;
    if (!std::isfinite(value)) return value;
    if (std::abs(value) > largest * rounding) return std::nullopt;
    return double(float(std::clamp(value, -largest, largest)));
  } else {
    // The largest numbers of 64 bits are no doubles; they round to powers of two.
    constexpr double least = double(std::numeric_limits<Number>::min()),
                     most = double(std::numeric_limits<Number>::max());
    return value == std::floor(value) && value >= least && value <= most ? std::optional(value) : std::nullopt;
  }
}

template <class Number>
class TextReader {
 public:
  TextReader(FileBytes& file, const Element& array) : file_(file), array_(array) {}

  /// At most `most` numbers.
  std::vector<double> read(std::size_t most) {
    ByteStream stream(file_, array_.text_begin, array_.text_end, false);
    std::vector<unsigned char> block(
        static_cast<std::size_t>(std::min<std::uint64_t>(chunk_bytes, array_.text_end - array_.text_begin)));
    std::string word;
    while (numbers_.size() < most) {
      const std::size_t got = stream.read(block.data(), block.size());
      if (got == 0) break;
      for (std::size_t i = 0; i < got; ++i) {
        const char c = static_cast<char>(block[i]);
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r')
          take(word);
        else
          word += c;
      }
    }
    take(word);
    return std::move(numbers_);
  }

  void reserve(std::size_t count) { numbers_.reserve(count); }

 private:
  void take(std::string& word) {
    if (word.empty()) return;
    const auto number = base::read_number<double>(word);
    if (!number)
      throw GridFileError(fmt::format("{}: {} is not a number: value {} of the array {}", line_of(file_, array_),
                                      shown(word), numbers_.size() + 1, array_name(array_)));
    const auto value = as_type<Number>(*number);
    if (!value)
      throw GridFileError(fmt::format("{}: {} in the array {} is no number of its type {}", line_of(file_, array_),
                                      *number, array_name(array_), type_of(array_)));
    numbers_.push_back(*value);
    word.clear();
  }

  FileBytes& file_;
  const Element& array_;
  std::vector<double> numbers_;
};

// ---- binary

bool is_text(const FileBytes& file, const Element& array) {
  if (array.attribute("offset")) return false;
  const std::string* format = array.attribute("format");
  if (!format || *format == "ascii") return true;
  if (*format == "binary") return false;
  if (*format == "appended") fail(file, array, "is appended, but it has no offset");
  fail(file, array, fmt::format("has the format {}", shown(*format)), "known formats: ascii, binary, appended");
}

template <class Word>
Word turned(Word word) {
  std::array<unsigned char, sizeof(Word)> bytes;
  std::memcpy(bytes.data(), &word, sizeof(Word));
  std::reverse(bytes.begin(), bytes.end());
  std::memcpy(&word, bytes.data(), sizeof(Word));
  return word;
}

/// A binary array behind its lengths.
struct Binary {
  std::uint64_t bytes = 0;  // of its numbers
  std::uint64_t data = 0;   // where they begin in the file
  std::size_t before = 0;   // bytes of the stream to pass over first
  std::uint64_t end = 0;    // where the file, or the text of the element, ends
  bool base64 = true;
  std::uint64_t block = 0;                // compressed: bytes of a whole block
  std::vector<std::uint64_t> compressed;  // bytes of each block in the file

  std::uint64_t block_size(std::size_t k) const {
    return k + 1 < compressed.size() || bytes % block == 0 ? block : bytes % block;
  }
};

class Lengths {
 public:
  Lengths(const FileBytes& file, const BinaryForm& form, const Element& array, ByteStream& stream)
      : file_(file), form_(form), array_(array), stream_(stream) {}
  std::uint64_t next() {
    std::array<unsigned char, 8> word{};
    if (stream_.read(word.data(), form_.header_bytes) != form_.header_bytes)
      fail_damaged(file_, array_, "the file ends within its length");
    read_ += form_.header_bytes;
    if (form_.header_bytes == 8) return value<std::uint64_t>(word.data());
    return value<std::uint32_t>(word.data());
  }
  std::size_t bytes_read() const { return read_; }

 private:
  template <class Word>
  std::uint64_t value(const unsigned char* bytes) const {
    Word word;
    std::memcpy(&word, bytes, sizeof(word));
    return form_.swapped ? turned(word) : word;
  }

  const FileBytes& file_;
  const BinaryForm& form_;
  const Element& array_;
  ByteStream& stream_;
  std::size_t read_ = 0;
};

std::uint64_t appended_place(const FileBytes& file, const BinaryForm& form, const Element& array) {
  const auto offset = base::read_number<std::uint64_t>(*array.attribute("offset"));
  if (!offset)
    fail(file, array, fmt::format("has offset = {}, which is no whole number", shown(array.attribute("offset"))));
  if (!form.appended) fail_damaged(file, array, "it is appended, but there is no <AppendedData>");
  if (*offset >= file.size() - std::min(file.size(), *form.appended))
    fail_damaged(file, array, fmt::format("offset = {} lies behind the end of the file", *offset));
  return *form.appended + *offset;
}

/// Reads the lengths. What they claim is checked against the size of the file.
Binary lengths_of(FileBytes& file, const BinaryForm& form, const Element& array) {
  if (!form.compressor.empty() && form.compressor != "vtkZLibDataCompressor")
    fail(file, array, fmt::format("is compressed by {}, which is not read", shown(form.compressor)),
         "save the file with the compressor ZLib, or without one");
  Binary result;
  const bool appended = array.attribute("offset") != nullptr;
  result.data = appended ? appended_place(file, form, array) : array.text_begin;
  result.end = appended ? file.size() : array.text_end;
  result.base64 = !(appended && form.raw);
  const auto room = [&] { return result.end - std::min(result.end, result.data); };  // base64 has fewer
  ByteStream stream(file, result.data, result.end, result.base64);
  Lengths lengths(file, form, array, stream);
  if (form.compressor.empty()) {
    result.bytes = lengths.next();
    result.before = lengths.bytes_read();
    if (result.bytes > room())
      fail_damaged(file, array, fmt::format("it claims {} bytes, more than the file has", result.bytes));
    return result;
  }
  const std::uint64_t blocks = lengths.next(), last = (result.block = lengths.next(), lengths.next());
  if (blocks > room() / form.header_bytes) fail_damaged(file, array, fmt::format("it claims {} blocks", blocks));
  if (blocks > 0 &&
      (result.block == 0 || last > result.block || result.block > std::numeric_limits<std::uint64_t>::max() / blocks))
    fail_damaged(file, array, fmt::format("its blocks have {} bytes, the last one {}", result.block, last));
  result.bytes = blocks == 0 ? 0 : (blocks - 1) * result.block + (last == 0 ? result.block : last);
  std::uint64_t sum = 0;
  result.compressed.reserve(static_cast<std::size_t>(blocks));
  for (std::uint64_t k = 0; k < blocks; ++k) {
    result.compressed.push_back(lengths.next());
    if (result.compressed.back() > room() - sum) fail_damaged(file, array, "its blocks are longer than the file");
    sum += result.compressed.back();
  }
  if (result.bytes / most_by_deflate > sum)
    fail_damaged(file, array, fmt::format("{} bytes cannot come out of {}", result.bytes, sum));
  result.data = stream.place();
  return result;
}

/// Words of a file become doubles; a word may come in two parts.
template <class Number>
class WordReader {
 public:
  /// `some`: no more than these are wanted. Else all are read to their end, where a checksum may stand.
  WordReader(bool swapped, std::size_t most, bool some) : swapped_(swapped), some_(some), most_(most) {
    numbers_.reserve(most);
  }
  bool enough() const { return some_ && numbers_.size() >= most_; }
  std::vector<double> numbers() { return std::move(numbers_); }

  void take(const unsigned char* bytes, std::size_t count) {
    while (count > 0 && numbers_.size() < most_) {
      if (part_size_ == 0 && count >= sizeof(Number)) {
        push(bytes);
        bytes += sizeof(Number), count -= sizeof(Number);
        continue;
      }
      part_[part_size_++] = *bytes++;
      --count;
      if (part_size_ == sizeof(Number)) push(part_.data()), part_size_ = 0;
    }
  }

 private:
  void push(const unsigned char* bytes) {
    Number number;
    std::memcpy(&number, bytes, sizeof(number));
    numbers_.push_back(static_cast<double>(swapped_ ? turned(number) : number));
  }

  bool swapped_, some_;
  std::size_t most_;
  std::array<unsigned char, sizeof(Number)> part_{};
  std::size_t part_size_ = 0;
  std::vector<double> numbers_;
};

class Inflater {
 public:
  Inflater() {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  /// One block of `in` bytes that becomes `out` bytes. False if it does not.
  template <class Words>
  bool block(ByteStream& source, std::uint64_t in, std::uint64_t out, Words& words) {
    inflateReset(&stream_);
    stream_.avail_in = 0;
    std::uint64_t done = 0;
    for (int state = Z_OK; state != Z_STREAM_END && !words.enough();) {
      if (stream_.avail_in == 0) {
        const std::size_t some = static_cast<std::size_t>(std::min<std::uint64_t>(in, from_.size()));
        if (some == 0 || source.read(from_.data(), some) != some) return false;
        in -= some;
        stream_.next_in = from_.data();
        stream_.avail_in = static_cast<uInt>(some);
      }
      stream_.next_out = to_.data();
      stream_.avail_out = static_cast<uInt>(to_.size());
      state = inflate(&stream_, Z_NO_FLUSH);
      if (state != Z_OK && state != Z_STREAM_END && !(state == Z_BUF_ERROR && stream_.avail_in == 0)) return false;
      const std::size_t got = to_.size() - stream_.avail_out;
      done += got;
      if (done > out) return false;
      words.take(to_.data(), got);
    }
    while (in > 0 && !words.enough()) {  // what a writer left behind the block
      const std::size_t some = static_cast<std::size_t>(std::min<std::uint64_t>(in, from_.size()));
      if (source.read(from_.data(), some) != some) return false;
      in -= some;
    }
    return done == out || words.enough();
  }

 private:
  z_stream stream_{};
  std::array<unsigned char, chunk_bytes> from_{}, to_{};
};

/// The first `count` numbers. `binary`: its lengths.
template <class Number>
std::vector<double> read_binary(FileBytes& file, const BinaryForm& form, const Element& array, const Binary& binary,
                                std::size_t count) {
  WordReader<Number> words(form.swapped, count, binary.bytes / sizeof(Number) > count);
  ByteStream source(file, binary.data, binary.end, binary.base64);
  if (form.compressor.empty()) {
    std::vector<unsigned char> chunk(std::min(chunk_bytes, std::max(binary.before, count * sizeof(Number))));
    source.read(chunk.data(), binary.before);
    for (std::uint64_t left = count * sizeof(Number); left > 0;) {
      const std::size_t some = static_cast<std::size_t>(std::min<std::uint64_t>(left, chunk.size()));
      if (source.read(chunk.data(), some) != some)
        fail_damaged(file, array, fmt::format("the file ends before its {} bytes", binary.bytes));
      words.take(chunk.data(), some);
      left -= some;
    }
  }
  const auto inflater = form.compressor.empty() ? nullptr : std::make_unique<Inflater>();
  for (std::size_t k = 0; k < binary.compressed.size() && !words.enough(); ++k)
    if (!inflater->block(source, binary.compressed[k], binary.block_size(k), words))
      fail_damaged(file, array, fmt::format("block {} of {} cannot be uncompressed", k + 1, binary.compressed.size()));
  if (!array.attribute("offset") && !words.enough() && !source.at_end())
    fail_damaged(file, array, fmt::format("something stands behind its {} bytes", binary.bytes));
  return words.numbers();
}

}  // namespace

BinaryForm binary_form(const FileBytes& file, const XmlFile& xml) {
  BinaryForm form;
  const auto complain = [&](const Element& element, const char* name, const std::string& value, const char* known) {
    throw GridFileError(fmt::format("{}: {} = {} is not known", line_of(file, element), name, shown(value)),
                        fmt::format("known values: {}", known));
  };
  const Element& root = xml.root;
  if (const std::string* order = root.attribute("byte_order")) {
    if (*order != "LittleEndian" && *order != "BigEndian")
      complain(root, "byte_order", *order, "LittleEndian, BigEndian");
    form.swapped = (*order == "LittleEndian") != (std::endian::native == std::endian::little);
  }
  if (const std::string* type = root.attribute("header_type")) {
    if (*type != "UInt32" && *type != "UInt64") complain(root, "header_type", *type, "UInt32, UInt64");
    form.header_bytes = *type == "UInt64" ? 8 : 4;
  }
  if (const std::string* compressor = root.attribute("compressor")) form.compressor = *compressor;
  form.appended = xml.appended;
  if (const Element* appended = root.child("AppendedData"))
    if (const std::string* encoding = appended->attribute("encoding")) {
      if (*encoding != "raw" && *encoding != "base64") complain(*appended, "encoding", *encoding, "raw, base64");
      form.raw = *encoding == "raw";
    }
  return form;
}

bool holds_numbers(const Element& array) {
  return with_type(type_of(array), [](auto) {});
}

bool is_single_precision(const Element& array) { return type_of(array) == "Float32"; }

void check_length(FileBytes& file, const BinaryForm& form, const Element& array, std::size_t count) {
  const std::size_t bytes = word_bytes(file, array);
  if (is_text(file, array)) {
    if (count > 0 && array.text_end - array.text_begin < 2 * count - 1) fail_count(file, array, false, count);
    return;
  }
  const Binary binary = lengths_of(file, form, array);
  if (binary.bytes / bytes != count) fail_count(file, array, binary.bytes / bytes > count, count);
  if (binary.bytes % bytes != 0)
    fail_damaged(file, array, fmt::format("its {} bytes are no multiple of {}", binary.bytes, bytes));
}

std::vector<double> read_numbers(FileBytes& file, const BinaryForm& form, const Element& array, std::size_t count) {
  std::vector<double> numbers;
  with_type(type_of(array), [&](auto number) {
    using Number = decltype(number);
    if (is_text(file, array)) {
      TextReader<Number> reader(file, array);
      reader.reserve(count + 1);
      numbers = reader.read(count + 1);
    } else {
      numbers = read_binary<Number>(file, form, array, lengths_of(file, form, array), count);
    }
  });
  if (numbers.size() != count) fail_count(file, array, numbers.size() > count, count);
  return numbers;
}

std::optional<double> first_number(FileBytes& file, const BinaryForm& form, const Element& array) {
  std::vector<double> numbers;
  with_type(type_of(array), [&](auto number) {
    using Number = decltype(number);
    if (is_text(file, array)) {
      numbers = TextReader<Number>(file, array).read(1);
    } else {
      const Binary binary = lengths_of(file, form, array);
      if (binary.bytes >= sizeof(Number)) numbers = read_binary<Number>(file, form, array, binary, 1);
    }
  });
  return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

}  // namespace gaussdrift::read
