#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "read/file_bytes.hpp"
#include "read/grid_file_error.hpp"
#include "read/whole_grid.hpp"

namespace gaussdrift::read {

namespace {

std::string upper(std::string_view text) {
  std::string all;
  for (const char c : text) all += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return all;
}

/// Numbers as they lie in a binary file: the most significant byte comes first.
template <class T>
double number_at(const char* from) {
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), from, sizeof(T));
  if constexpr (std::endian::native == std::endian::little) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return static_cast<double>(value);
}

struct Type {
  std::string_view name;
  std::size_t bytes;
  double (*number)(const char*);
};
constexpr std::array<Type, 13> types{{{"CHAR", 1, number_at<signed char>},
                                      {"UNSIGNED_CHAR", 1, number_at<unsigned char>},
                                      {"SHORT", 2, number_at<std::int16_t>},
                                      {"UNSIGNED_SHORT", 2, number_at<std::uint16_t>},
                                      {"INT", 4, number_at<std::int32_t>},
                                      {"UNSIGNED_INT", 4, number_at<std::uint32_t>},
                                      {"LONG", 8, number_at<std::int64_t>},
                                      {"UNSIGNED_LONG", 8, number_at<std::uint64_t>},
                                      {"VTKTYPEINT64", 8, number_at<std::int64_t>},
                                      {"VTKTYPEUINT64", 8, number_at<std::uint64_t>},
                                      {"VTKIDTYPE", 8, number_at<std::int64_t>},
                                      {"FLOAT", 4, number_at<float>},
                                      {"DOUBLE", 8, number_at<double>}}};

/// One file while it is read.
class Legacy {
 public:
  explicit Legacy(const std::filesystem::path& file) : bytes_(file) {
    text_.resize(static_cast<std::size_t>(bytes_.size()));
    text_.resize(bytes_.read(0, text_.data(), text_.size()));
  }

  WholeGrid read() {
    head();
    while (const auto word = next_word()) section(upper(*word));
    if (grid_.axis[0].empty()) coordinates_of_image();
    for (std::size_t k = 0; k < 3; ++k) check_axis(k);
    return std::move(grid_);
  }

 private:
  [[noreturn]] void fail(const std::string& what, const std::string& remedy = "") const {
    const auto line =
        1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size())), '\n');
    throw GridFileError(fmt::format("{}:{}: {}", bytes_.name(), line, what), remedy);
  }

  std::string line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string all = text_.substr(std::min(at_, text_.size()), end - std::min(at_, text_.size()));
    at_ = std::min(end + 1, text_.size());
    if (!all.empty() && all.back() == '\r') all.pop_back();
    return all;
  }
  std::optional<std::string> next_word() {
    const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (at_ < text_.size() && blank(text_[at_])) ++at_;
    const std::size_t from = at_;
    while (at_ < text_.size() && !blank(text_[at_])) ++at_;
    if (from == at_) return std::nullopt;
    return text_.substr(from, at_ - from);
  }
  std::string word(std::string_view what) {
    const auto found = next_word();
    if (!found) fail(fmt::format("the file ends where {} should stand", what));
    return *found;
  }
  double number(std::string_view what) {
    const std::string text = word(what);
    double value = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size())
      fail(fmt::format("\"{}\" is no number", text.substr(0, 60)));
    return value;
  }
  std::size_t count(std::string_view what) {
    const double value = number(what);
    if (!(value >= 0 && value <= most_numbers && value == std::floor(value)))
      fail(fmt::format("{} is {}, and cannot be", what, value));
    return static_cast<std::size_t>(value);
  }

  void head() {
    if (line().rfind("# vtk DataFile Version", 0) != 0)
      fail("this is no legacy file of VTK: it does not begin with \"# vtk DataFile Version\"");
    line();  // a title
    const std::string form = upper(word("ASCII or BINARY"));
    if (form != "ASCII" && form != "BINARY")
      fail(fmt::format("\"{}\" stands where ASCII or BINARY should", form.substr(0, 60)));
    binary_ = form == "BINARY";
    if (upper(word("DATASET")) != "DATASET") fail("DATASET should stand here");
    kind_ = upper(word("the kind of the data"));
    if (kind_ != "STRUCTURED_POINTS" && kind_ != "RECTILINEAR_GRID")
      fail(fmt::format("{} has data of the kind {}", bytes_.name(), kind_.substr(0, 60)),
           "STRUCTURED_POINTS and RECTILINEAR_GRID are read; ParaView's filter Resample To Image makes a grid of "
           "others");
  }

  void section(const std::string& word) {
    if (word == "DIMENSIONS") {
      double all = 1;
      for (std::size_t& length : grid_.points) all *= static_cast<double>(length = count("a number of points"));
      if (!(all >= 1 && all <= most_numbers)) fail(fmt::format("the grid has {:.3g} points", all));
      known_ = true;
    } else if (word == "ORIGIN") {
      for (double& x : origin_) x = number("the origin");
    } else if (word == "SPACING" || word == "ASPECT_RATIO") {
      for (double& x : spacing_) x = number("a spacing");
    } else if (word.size() == 13 && word.substr(1) == "_COORDINATES" && word[0] >= 'X' && word[0] <= 'Z') {
      const auto k = static_cast<std::size_t>(word[0] - 'X');
      const std::size_t length = count("a number of coordinates");
      const Type& type = type_of(this->word("a type"));
      if (!known_ || length != grid_.points[k])
        fail(fmt::format("{} does not have as many numbers as DIMENSIONS says", word));
      grid_.axis[k] = numbers(type, length);
      if (type.name == "FLOAT") single_[k] = true;
    } else if (word == "POINT_DATA" || word == "CELL_DATA") {
      if (!known_) fail("DIMENSIONS is missing");
      on_cells_ = word == "CELL_DATA";
      entries_ = 1;
      for (const std::size_t length : grid_.points)
        entries_ *= on_cells_ ? std::max<std::size_t>(1, length - 1) : length;
      if (count(word) != entries_)
        fail(fmt::format("{} does not have as many entries as the grid, {}", word, entries_));
    } else if (word == "SCALARS") {
      scalars();
    } else if (word == "VECTORS" || word == "NORMALS") {
      const std::string name = this->word("a name");
      array(name, 3, type_of(this->word("a type")));
    } else if (word == "FIELD") {
      field();
    } else if (word == "METADATA") {
      while (at_ < text_.size() && !line().empty()) continue;  // the rest of its line
      while (at_ < text_.size() && !line().empty()) continue;
    } else {
      fail(fmt::format("\"{}\" is not read", word.substr(0, 60)),
           "SCALARS, VECTORS and FIELD are; ParaView saves the data as .vti or .vtr");
    }
  }

  void scalars() {
    const std::string name = word("a name");
    const Type& type = type_of(word("a type"));
    std::size_t components = 1;
    std::string next = word("LOOKUP_TABLE");
    if (upper(next) != "LOOKUP_TABLE") {
      const auto read = std::from_chars(next.data(), next.data() + next.size(), components);
      if (read.ec != std::errc() || components < 1 || components > 4)
        fail(fmt::format("{} has {} components", name, next));
      next = word("LOOKUP_TABLE");
    }
    if (upper(next) != "LOOKUP_TABLE") fail("LOOKUP_TABLE should stand here");
    word("the name of a table of colours");
    array(name, components, type);
  }

  void field() {
    word("a name");
    const std::size_t arrays = count("a number of arrays");
    for (std::size_t i = 0; i < arrays; ++i) {
      std::string name = word("a name");
      while (upper(name) == "METADATA") {
        section("METADATA");
        name = word("a name");
      }
      const std::size_t components = count("a number of components"), tuples = count("a number of entries");
      const Type& type = type_of(word("a type"));
      if (components < 1 || static_cast<double>(components) * static_cast<double>(tuples) > most_numbers)
        fail(fmt::format("{} has {} components of {} entries", name, components, tuples));
      if (entries_ > 0 && tuples == entries_) {
        array(name, components, type);
      } else {
        const std::vector<double> some = numbers(type, components * tuples);
        if (name == "TIME" && !some.empty()) grid_.time = some[0];
      }
    }
  }

  const Type& type_of(const std::string& name) const {
    const std::string wanted = upper(name);
    for (const Type& type : types)
      if (type.name == wanted) return type;
    fail(fmt::format("\"{}\" is no type of numbers that is read", name.substr(0, 60)));
  }

  void array(const std::string& name, std::size_t components, const Type& type) {
    if (entries_ == 0) fail("POINT_DATA or CELL_DATA is missing");
    grid_.arrays.push_back({name, components, on_cells_});
    grid_.values.push_back({numbers(type, entries_ * components), {}});
  }

  /// The file has them before memory is taken.
  std::vector<double> numbers(const Type& type, std::size_t length) {
    std::vector<double> values;
    if (binary_) {
      line();  // to the end of it
      if (text_.size() - at_ < length * type.bytes)
        fail("the file ends within its numbers", "it is cut off: copy it again");
      values.reserve(length);
      for (std::size_t i = 0; i < length; ++i, at_ += type.bytes) values.push_back(type.number(text_.data() + at_));
      return values;
    }
    if (text_.size() - at_ < length) fail("the file ends within its numbers", "it is cut off: copy it again");
    values.reserve(length);
    for (std::size_t i = 0; i < length; ++i) values.push_back(number("a number"));
    return values;
  }

  void coordinates_of_image() {
    if (!known_) fail("DIMENSIONS is missing");
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < grid_.points[k]; ++i)
        grid_.axis[k].push_back(origin_[k] + spacing_[k] * static_cast<double>(i));
  }

  void check_axis(std::size_t k) {
    const std::vector<double>& x = grid_.axis[k];
    if (x.size() != grid_.points[k]) fail(fmt::format("the coordinates along {} are missing", "xyz"[k]));
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(x[i])) fail(fmt::format("the {} coordinate of point {} is {}", "xyz"[k], i + 1, x[i]));
      if (i > 0 && (x[1] > x[0] ? !(x[i] > x[i - 1]) : !(x[i] < x[i - 1])))
        fail(fmt::format("the {} coordinates neither ascend nor descend: {} comes after {}", "xyz"[k], x[i], x[i - 1]));
      largest = std::max(largest, std::abs(x[i]));
    }
    // Text has about seven digits, as single precision does.
    if (single_[k] || !binary_) grid_.rounding[k] = 4 * double(std::numeric_limits<float>::epsilon()) * largest;
  }

  FileBytes bytes_;
  std::string text_, kind_;
  std::size_t at_ = 0;
  bool binary_ = false, known_ = false, on_cells_ = false;
  std::size_t entries_ = 0;  // of arrays
  std::array<double, 3> origin_{}, spacing_{1, 1, 1};
  std::array<bool, 3> single_{};
  WholeGrid grid_;
};

}  // namespace

WholeGrid read_legacy_vtk(const std::filesystem::path& file) { return Legacy(file).read(); }

}  // namespace gaussdrift::read
