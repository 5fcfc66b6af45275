// What ranks say to each other for a plan: bytes that are counted, and errors that all of them throw.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

#include "farfield/farfield.hpp"

namespace farfield::detail {

using Bytes = Ranks::Bytes;

class Channel {
 public:
  explicit Channel(Ranks& ranks) : ranks_(ranks) {}

  std::size_t rank() const { return static_cast<std::size_t>(ranks_.rank()); }
  std::size_t size() const { return static_cast<std::size_t>(ranks_.size()); }

  std::vector<Bytes> exchange(std::vector<Bytes> out) const;
  /// Adds to `received` how many bytes came from others.
  std::vector<Bytes> exchange(std::vector<Bytes> out, double& received) const;
  void sum(std::vector<std::int64_t>& numbers) const { ranks_.sum(numbers); }
  void max(std::vector<double>& numbers) const { ranks_.max(numbers); }

  /// Does `work`, which must not communicate, on every rank. If it throws an Error on one or more, all ranks throw that
  /// of the lowest of them. Other exceptions leave at once.
  void together(const std::function<void()>& work) const;

 private:
  Ranks& ranks_;
};

/// Appends values to bytes.
class Writer {
 public:
  template <class Value>
  void put(const Value& value) {
    put(&value, 1);
  }
  template <class Value>
  void put(const Value* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<Value>);
    const auto* const first = reinterpret_cast<const std::byte*>(values);
    bytes_.insert(bytes_.end(), first, first + count * sizeof(Value));
  }
  /// Their number, then they.
  template <class Value>
  void put_list(const std::vector<Value>& values) {
    put(values.size());
    put(values.data(), values.size());
  }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

/// Takes them off again, in the same order.
class Reader {
 public:
  explicit Reader(const Bytes& bytes) : bytes_(bytes) {}
  bool at_end() const { return at_ == bytes_.size(); }
  template <class Value>
  Value get() {
    Value value;
    get(&value, 1);
    return value;
  }
  template <class Value>
  void get(Value* values, std::size_t count) {
    if (bytes_.size() - at_ < count * sizeof(Value)) throw Error("farfield: a rank sent fewer bytes than expected");
    if (count > 0) std::memcpy(values, bytes_.data() + at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }
  template <class Value>
  std::vector<Value> get_list() {
    const auto count = get<std::size_t>();
    if ((bytes_.size() - at_) / sizeof(Value) < count) throw Error("farfield: a rank sent fewer bytes than expected");
    std::vector<Value> values(count);
    get(values.data(), count);
    return values;
  }

 private:
  const Bytes& bytes_;
  std::size_t at_ = 0;
};

}  // namespace farfield::detail
