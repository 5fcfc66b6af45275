#include "write/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gaussdrift/error.hpp"
#include "write/wide_hash.hpp"

namespace gaussdrift::write {

namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0)
      if (const std::size_t colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "unknown";
}

std::string date() {
  std::int64_t seconds = std::time(nullptr);
  if (const char* text = std::getenv("SOURCE_DATE_EPOCH")) {
    constexpr std::int64_t year_10000 = 253402300800;
    const char* end = text + std::strlen(text);
    const auto read = std::from_chars(text, end, seconds);
    if (read.ec != std::errc() || read.ptr != end || seconds < 0 || seconds >= year_10000)
      throw InputError(
          fmt::format("SOURCE_DATE_EPOCH = \"{}\" must be a whole number of seconds since 1970, before the year 10000; "
                      "unset it, or "
                      "set it as in SOURCE_DATE_EPOCH=1700000000",
                      text));
  }
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

/// The hash of bytes, fed piece by piece.
class Hash {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  }
  std::string text() const { return fmt::format("fnv1a64:{:016x}", value_); }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

std::string read_hash_of_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  WideHash hash;
  std::vector<char> piece(1 << 16);
  while (in) {
    in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    hash.add({piece.data(), static_cast<std::size_t>(in.gcount())});
  }
  if (!in.eof()) throw FileError(fmt::format("{} cannot be read", file.string()));
  return fmt::format("xxh64:{:016x}", hash.value());
}

/// Each file is read once by a process, and again if it has changed.
std::string hash_of_file(const std::filesystem::path& file) {
  struct Known {
    std::uintmax_t size;
    std::filesystem::file_time_type changed;
    std::string hash;
  };
  static std::mutex mutex;
  static std::map<std::filesystem::path, Known> known;
  std::error_code error, more;
  const std::filesystem::path path = std::filesystem::absolute(file).lexically_normal();
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const auto changed = std::filesystem::last_write_time(path, more);
  const std::lock_guard<std::mutex> lock(mutex);
  if (const auto at = known.find(path);
      !error && !more && at != known.end() && at->second.size == size && at->second.changed == changed)
    return at->second.hash;
  std::string hash = read_hash_of_file(path);
  if (!error && !more) known[path] = {size, changed, hash};
  return hash;
}

}  // namespace

std::string program_version() { return GAUSSDRIFT_VERSION; }

std::string made_by() {
  return fmt::format("gaussdrift {}, {}, {}", GAUSSDRIFT_VERSION, GAUSSDRIFT_COMPILER, processor());
}

std::string hash_of(const std::string& text) {
  Hash hash;
  hash.add(text);
  return hash.text();
}

std::string hash_of(const std::string& text, const std::vector<DataFile>& data) {
  std::string all = text;
  for (const DataFile& each : data) all += hash_of_file(each.file);
  return hash_of(all);
}

std::string provenance_json(const Case& spec, const std::string& resolved, const std::vector<DataFile>& data,
                            const std::string& command, int threads) {
  using json = nlohmann::ordered_json;
  json document{{"name", spec.name},
                {"version", GAUSSDRIFT_VERSION},
                {"compiler", GAUSSDRIFT_COMPILER},
                {"flags", GAUSSDRIFT_FLAGS},
                {"processor", processor()},
                {"threads", threads},
                {"command", command},
                {"date", date()},
                {"case", hash_of(spec.source)}};
  json files = json::array(), paths = json::object();  // absolute, for a folder that is moved
  std::string all = resolved;                          // as in hash_of()
  for (const DataFile& each : data) {
    const std::string hash = hash_of_file(each.file);
    all += hash;
    files.push_back({{"file", each.name}, {"hash", hash}});
    paths[each.name] = std::filesystem::absolute(each.file).lexically_normal().string();
  }
  document["resolved_case"] = hash_of(all);
  if (!files.empty()) document["data"] = files, document["data_paths"] = paths;
  return document.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::write
