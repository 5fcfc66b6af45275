#include "base/json_file.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "gaussdrift/error.hpp"

namespace gaussdrift::base {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

namespace {

constexpr std::size_t deepest = 50;         // what gaussdrift writes is 6 deep
constexpr std::size_t most_members = 1000;  // of an object, which is searched from its first member to its last

/// Looks at the events of a text, without memory for it. The reason is empty if it may become an object.
class Look : public nlohmann::json_sax<json> {
 public:
  explicit Look(std::string_view text) : text_(text) {}
  const std::string& reason() const { return reason_; }

  bool null() override { return inside(); }
  bool boolean(bool /*value*/) override { return inside(); }
  bool number_integer(number_integer_t /*value*/) override { return inside(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return inside(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return inside(); }
  bool string(string_t& /*text*/) override { return inside(); }
  bool binary(binary_t& /*bytes*/) override { return inside(); }
  bool start_array(std::size_t /*count*/) override { return inside() && enter(); }
  bool end_array() override { return leave(); }
  bool start_object(std::size_t /*count*/) override { return enter(); }
  bool end_object() override { return leave(); }
  bool key(string_t& /*name*/) override {
    return ++members_.back() <= most_members ||
           refuse("an object in it has more than " + std::to_string(most_members) + " members");
  }
  bool parse_error(std::size_t position, const std::string& /*token*/, const json::exception& error) override {
    const std::string_view before = text_.substr(0, position == 0 ? 0 : std::min(position - 1, text_.size()));
    const std::size_t line = before.rfind('\n');
    const auto ends = std::count(before.begin(), before.end(), '\n');
    const std::size_t column = before.size() - (line == before.npos ? 0 : line + 1);
    constexpr int number_too_large = 406;
    return refuse("line " + std::to_string(ends + 1) + ", column " + std::to_string(column + 1) +
                  (error.id == number_too_large ? ": a number is too large" : ": this is no JSON"));
  }

 private:
  bool refuse(const std::string& why) {
    reason_ = why;
    return false;
  }
  /// Values beside the object are refused as soon as they are seen.
  bool inside() { return !members_.empty() || refuse("it is no JSON object"); }
  bool enter() {
    members_.push_back(0);
    return members_.size() <= deepest || refuse("it is nested more than " + std::to_string(deepest) + " deep");
  }
  bool leave() {
    members_.pop_back();
    return true;
  }

  std::string_view text_;
  std::vector<std::size_t> members_;  // of the objects around; of arrays 0
  std::string reason_;
};

/// Of a regular file; the reason where it cannot be had.
std::string read_whole(const fs::path& file, const fs::file_status& status, std::size_t most_bytes,
                       std::string& reason) {
  std::error_code error;
  const auto size = fs::is_regular_file(status) ? fs::file_size(file, error) : std::uintmax_t{0};
  std::string text;
  if (fs::is_symlink(status))
    reason = "it is a link, and links are not followed";
  else if (!fs::is_regular_file(status))
    reason = "it is no regular file";
  else if (!error && size > most_bytes)
    reason = "it has " + std::to_string(size) + " bytes, at most " + std::to_string(most_bytes) + " are read";
  if (!reason.empty()) return text;
  std::ifstream in(file, std::ios::binary);
  text.resize(error ? 0 : static_cast<std::size_t>(size));
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (error || !in) reason = "it cannot be read";
  return text;
}

/// Why a text is no object; empty: it is one.
std::string why_no_object(std::string_view text) {
  Look look(text);
  json::sax_parse(text, &look);
  return look.reason();
}

}  // namespace

json json_in(std::string_view text) {
  if (const std::string reason = why_no_object(text); !reason.empty()) throw std::out_of_range(reason);
  return json::parse(text);
}

std::optional<json> json_if_there(const fs::path& file, std::size_t most_bytes, std::string_view remedy) {
  std::error_code error;
  const fs::file_status status = fs::symlink_status(file, error);
  if (status.type() == fs::file_type::not_found) return std::nullopt;
  std::string reason;
  const std::string text = read_whole(file, status, most_bytes, reason);
  if (reason.empty()) reason = why_no_object(text);
  if (reason.empty()) return json::parse(text);
  throw FileError(file.string() + " is damaged: " + reason + "; " + std::string(remedy));
}

}  // namespace gaussdrift::base
