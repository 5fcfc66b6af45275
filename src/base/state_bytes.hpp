// What something has gathered, as bytes: one function of it serves to write and to read, so that both agree.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace gaussdrift::base {

/// Passes values to bytes or from bytes, in the order of the calls. Numbers have the bits and the byte order of this
/// machine: little-endian, on all that the program is built for.
class StateBytes {
 public:
  /// Writes.
  StateBytes() = default;
  /// Reads. The bytes must outlive it.
  explicit StateBytes(std::string_view bytes) : reading_(true), left_(bytes) {}

  bool reading() const { return reading_; }
  const std::string& written() const { return bytes_; }
  /// While reading: are bytes left?
  bool has_more() const { return !left_.empty(); }
  /// Throws std::out_of_range if bytes are left that nobody has asked for.
  void end() const {
    if (reading_ && !left_.empty()) throw std::out_of_range("there is more than expected");
  }

  /// Reads into the values, or writes them. Throws std::out_of_range where there are too few bytes.
  template <class... Values>
  void operator()(Values&... values) {
    (pass(values), ...);
  }

 private:
  template <class Value>
  void pass(Value& value) requires std::is_trivially_copyable_v<Value> {
    raw(&value, sizeof value);
  }
  void pass(bool& value) {  // any other byte is no bool, and reading it as one is undefined
    auto byte = static_cast<unsigned char>(reading_ ? 0 : value);
    raw(&byte, sizeof byte);
    if (byte > 1) throw std::out_of_range("a byte is neither true nor false");
    value = byte == 1;
  }
  void pass(std::string& text) {
    std::uint64_t size = text.size();
    pass(size);
    if (reading_)
      text.assign(take(size));
    else
      bytes_ += text;
  }
  template <class Value>
  void pass(std::vector<Value>& values) {
    std::uint64_t size = values.size();
    pass(size);
    if (reading_) {
      if (size > left_.size()) throw std::out_of_range("there is less than expected");  // each takes a byte at least
      values.resize(size);
    }
    if constexpr (std::is_trivially_copyable_v<Value>)
      raw(values.data(), size * sizeof(Value));
    else
      for (Value& value : values) pass(value);
  }
  template <class First, class Second>
  void pass(std::pair<First, Second>& both) {
    pass(both.first), pass(both.second);
  }
  template <class Value>
  void pass(std::optional<Value>& value) {
    bool there = value.has_value();
    pass(there);
    if (reading_) value = there ? std::optional<Value>(Value{}) : std::nullopt;
    if (there) pass(*value);
  }

  void raw(void* data, std::size_t size) {
    if (size == 0) return;
    if (reading_)
      std::memcpy(data, take(size).data(), size);
    else
      bytes_.append(static_cast<const char*>(data), size);
  }
  std::string_view take(std::uint64_t size) {
    if (size > left_.size()) throw std::out_of_range("there is less than expected");
    const std::string_view part = left_.substr(0, size);
    left_.remove_prefix(size);
    return part;
  }

  bool reading_ = false;
  std::string bytes_;
  std::string_view left_;
};

}  // namespace gaussdrift::base
