#include "write/checkpoint.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "base/json_file.hpp"
#include "base/parallel.hpp"
#include "gaussdrift/error.hpp"
#include "particle/columns.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

namespace {

constexpr const char* kind = "gaussdrift checkpoint";
constexpr int version = 1;
constexpr std::size_t most_in_a_piece = std::size_t{1} << 22;  // particles; of any version
constexpr std::size_t in_a_piece = std::size_t{1} << 20;       // so that threads share ten million evenly
constexpr const char* manifest_name = "manifest.json";

fs::path slot(const fs::path& folder, int number) { return folder / checkpoints_folder / std::to_string(number); }
fs::path piece_file(std::size_t number) { return fmt::format("particles_{:04}.raw", number); }
constexpr const char* state_file = "run.raw";

json columns_of(const Particles& particles) {
  json names = json::array();
  for_each_column(particles, [&](std::string_view name, std::size_t number, const auto&) {
    const bool numbered = name == "position" || name == "path";
    names.push_back(numbered ? fmt::format("{}_{}", name, number) : std::string(name));
  });
  return names;
}

/// A file that is written or read in large parts, with a check sum of all of them.
class RawFile {
 public:
  /// Reads.
  explicit RawFile(const fs::path& file) : own_(std::fopen(file.c_str(), "rb"), &std::fclose), file_(own_.get()) {
    if (!file_) throw std::system_error(errno, std::generic_category());
  }
  /// Writes.
  explicit RawFile(std::FILE* file) : own_(nullptr, &std::fclose), file_(file) {}
  void write(const void* data, std::size_t bytes) {
    add(data, bytes);
    if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes)
      throw std::system_error(errno, std::generic_category());
  }
  void read(void* data, std::size_t bytes) {
    if (bytes > 0 && std::fread(data, 1, bytes, file_) != bytes) throw std::runtime_error("it is cut short");
    add(data, bytes);
  }
  std::uint64_t sum() const { return sum_; }
  std::size_t bytes() const { return bytes_; }

 private:
  void add(const void* data, std::size_t bytes) {
    sum_ = crc32_z(sum_, static_cast<const Bytef*>(data), bytes);
    bytes_ += bytes;
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> own_;
  std::FILE* file_;
  uLong sum_ = crc32_z(0, nullptr, 0);
  std::size_t bytes_ = 0;
};

/// Writes a whole file and tells what the manifest says of it.
template <class Write>
json write_raw(const fs::path& folder, const fs::path& name, const InHaste& in_haste, const Write& write) {
  json entry{{"file", name.string()}};
  const auto write_and_sum = [&](std::FILE* part) {
    RawFile file(part);
    write(file);
    entry["bytes"] = file.bytes();
    entry["crc32"] = file.sum();
  };
  write_atomically(folder / name, write_and_sum, in_haste);
  return entry;
}

/// Of a manifest without its own check sum.
std::uint64_t sum_of(const json& manifest) {
  const std::string text = manifest.dump();
  return crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(text.data()), text.size());
}

[[noreturn]] void refuse_member(const char* name, const char* must_be) {
  throw std::runtime_error(fmt::format("its manifest is damaged: {} is no {}", name, must_be));
}

const json& member(const json& object, const char* name) {
  static const json none;
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

std::uint64_t count_in(const json& object, const char* name) {
  const json& value = member(object, name);
  if (!value.is_number_unsigned()) refuse_member(name, "count");
  return value.get<std::uint64_t>();
}

double number_in(const json& object, const char* name) {
  const json& value = member(object, name);
  if (!value.is_number()) refuse_member(name, "number");
  return value.get<double>();
}

std::string text_in(const json& object, const char* name) {
  const json& value = member(object, name);
  if (!value.is_string()) refuse_member(name, "text");
  return value.get<std::string>();
}

const json& list_in(const json& object, const char* name) {
  const json& value = member(object, name);
  if (!value.is_array()) refuse_member(name, "list");
  return value;
}

json read_manifest(const fs::path& folder) {
  auto read = base::json_if_there(folder / manifest_name, base::most_json_of_names, "it is written anew");
  if (!read) throw std::runtime_error("it has no manifest");
  json manifest = std::move(*read);
  if (member(manifest, "kind") != kind) throw std::runtime_error("its manifest is none of a checkpoint");
  if (const auto written = count_in(manifest, "version"); written > version)
    throw std::runtime_error(
        fmt::format("it was written by a newer gaussdrift (format {}, this one knows {})", written, version));
  const auto sum = count_in(manifest, "crc32");
  manifest.erase("crc32");
  if (sum != sum_of(manifest)) throw std::runtime_error("its manifest is damaged: its check sum is wrong");
  return manifest;
}

std::uint64_t serial_of(const fs::path& folder) {
  try {
    return count_in(read_manifest(folder), "serial");
  } catch (const std::exception&) {
    return 0;  // what cannot be read is overwritten first
  }
}

/// Checks what the manifest says of a file against its size, before memory is taken for it.
RawFile open_checked(const fs::path& folder, const json& entry, std::size_t expected) {
  const auto name = text_in(entry, "file");
  if (fs::path(name).has_parent_path() || name.find("..") != std::string::npos || name.find('\0') != std::string::npos)
    throw std::runtime_error("its manifest names a file elsewhere");
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(folder / name, error)))
    throw std::runtime_error(fmt::format("{} is missing", name));
  const auto bytes = fs::file_size(folder / name, error);
  if (error || bytes != expected || count_in(entry, "bytes") != expected)
    throw std::runtime_error(fmt::format("{} has {} bytes, must have {}", name, bytes, expected));
  return RawFile(folder / name);
}

void check_sum(const RawFile& file, const json& entry) {
  if (file.sum() != count_in(entry, "crc32"))
    throw std::runtime_error(fmt::format("{} is damaged: its check sum is wrong", text_in(entry, "file")));
}

Checkpoint read_slot(const fs::path& folder, const json& manifest) {
  Checkpoint checkpoint;
  const auto count = count_in(manifest, "particles");
  CheckpointFacts& facts = checkpoint.facts;
  facts = {number_in(manifest, "time"), count_in(manifest, "steps"), count, 0};
  Particles& particles = checkpoint.particles;
  const auto dimension = count_in(manifest, "dimension");
  if (dimension < 1 || dimension > max_dimension) throw std::runtime_error("its dimension is wrong");
  particles.dimension = static_cast<int>(dimension);
  const json& columns = list_in(manifest, "columns");
  const auto paths = count_in(manifest, "paths");
  if (paths > columns.size()) throw std::runtime_error("its columns are wrong");
  particles.path.resize(paths);
  if (columns.size() > static_cast<std::size_t>(particles.dimension) + 2 + paths) particles.volume.resize(1);
  if (columns_of(particles) != columns) throw std::runtime_error("its columns are wrong");

  // All sizes before any memory. A file that counted twice would need more memory than it has bytes.
  std::size_t there = 0;
  const json& pieces = list_in(manifest, "pieces");
  std::set<std::string> names;
  for (const json& piece : pieces) {
    const auto in_piece = count_in(piece, "particles");
    if (in_piece > most_in_a_piece || !names.insert(text_in(piece, "file")).second)
      throw std::runtime_error("its pieces are wrong");
    open_checked(folder, piece, in_piece * 8 * columns.size());
    there += in_piece;
  }
  if (there != count) throw std::runtime_error("its pieces are wrong");
  for_each_column(particles, [&](std::string_view, std::size_t, auto& column) { column.resize(count); });
  std::size_t first = 0;
  for (const json& piece : pieces) {
    const auto in_piece = count_in(piece, "particles");
    RawFile file = open_checked(folder, piece, in_piece * 8 * columns.size());
    for_each_column(particles, [&](std::string_view, std::size_t, auto& column) {
      file.read(column.data() + first, 8 * in_piece);
    });
    check_sum(file, piece);
    first += in_piece;
    facts.bytes += static_cast<double>(file.bytes());
  }
  const json& state = member(manifest, "state");
  const auto bytes = count_in(state, "bytes");
  RawFile file = open_checked(folder, state, bytes);
  checkpoint.state.resize(bytes);
  file.read(checkpoint.state.data(), checkpoint.state.size());
  check_sum(file, state);
  facts.bytes += static_cast<double>(file.bytes());
  particles.spread = std::strtod(text_in(manifest, "spread").c_str(), nullptr);
  if (!(particles.spread >= 0 && std::isfinite(particles.spread))) refuse_member("spread", "width");
  return checkpoint;
}

/// Of a checkpoint that is to be replaced. Its manifest goes first: from then on it is none.
void clear_slot(const fs::path& here) {
  std::error_code error;
  fs::remove(here / manifest_name, error);
  if (error) throw FileError(fmt::format("{} cannot be replaced: {}", here.string(), error.message()));
  // Removed, not replaced: some systems write a file to the disk at once when it replaces another.
  std::size_t number = 0;
  while (fs::remove(here / piece_file(number++), error)) {
  }
}

}  // namespace

CheckpointFacts write_checkpoint(const fs::path& folder, const std::string& past, double time, std::size_t steps,
                                 const Particles& particles, const std::string& state, int threads,
                                 const InHaste& in_haste) {
  const std::uint64_t serials[] = {serial_of(slot(folder, 0)), serial_of(slot(folder, 1))};
  const int older = serials[0] <= serials[1] ? 0 : 1;
  const fs::path here = slot(folder, older);
  clear_slot(here);

  CheckpointFacts facts{time, steps, particles.size(), 0};
  json manifest{{"kind", kind},
                {"version", version},
                {"serial", std::max(serials[0], serials[1]) + 1},
                {"case", past},
                {"time", time},
                {"steps", steps},
                {"particles", particles.size()},
                {"dimension", particles.dimension},
                {"paths", particles.path.size()},
                {"spread", fmt::format("{:a}", particles.spread)},
                {"columns", columns_of(particles)}};
  std::vector<json> pieces((particles.size() + in_a_piece - 1) / in_a_piece);
  const double all_bytes = bytes_of_checkpoint(particles), a_second = 5e8;
  base::parallel_for({pieces.size(), all_bytes / a_second}, threads, [&](std::size_t number) {
    const std::size_t first = number * in_a_piece, count = std::min(in_a_piece, particles.size() - first);
    pieces[number] = write_raw(here, piece_file(number), in_haste, [&](RawFile& file) {
      for_each_column(particles, [&](std::string_view, std::size_t, const auto& column) {
        file.write(column.data() + first, 8 * count);
      });
    });
    pieces[number]["particles"] = count;
  });
  for (const json& piece : pieces) facts.bytes += piece["bytes"].get<double>();
  manifest["pieces"] = std::move(pieces);
  manifest["state"] =
      write_raw(here, state_file, in_haste, [&](RawFile& file) { file.write(state.data(), state.size()); });
  facts.bytes += manifest["state"]["bytes"].get<double>();
  manifest["crc32"] = sum_of(manifest);
  write_text(here / manifest_name, manifest.dump(2) + "\n", in_haste);
  return facts;
}

bool force_checkpoints(const fs::path& folder, const InHaste& in_haste) {
  for (const fs::path& file : checkpoint_files(folder)) {
    std::error_code ignored;
    if (!fs::is_regular_file(fs::symlink_status(file, ignored))) continue;  // of a stranger, and none of a checkpoint
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor < 0) fail_to_write(file, errno);
    try {
      const bool forced = force_to_disk(descriptor, in_haste);
      ::close(descriptor);
      if (!forced) return false;
    } catch (const std::system_error& error) {
      ::close(descriptor);
      fail_to_write(file, error.code().value());
    }
  }
  try {
    for (const int number : {0, 1})
      if (fs::exists(slot(folder, number))) flush_folder(slot(folder, number));
  } catch (const std::system_error& error) {
    fail_to_write(folder / checkpoints_folder, error.code().value());
  }
  return true;
}

std::optional<Checkpoint> read_checkpoint(const fs::path& folder, const std::string& past,
                                          std::vector<std::string>& refused) {
  struct Found {
    std::uint64_t serial;
    int number;
    json manifest;
  };
  std::vector<Found> found;
  const auto refuse = [&](int number, const char* why) {
    refused.push_back(fmt::format("the checkpoint in {} is not used: {}", slot(folder, number).string(), why));
  };
  for (const int number : {0, 1}) {
    std::error_code error;
    if (!fs::exists(slot(folder, number) / manifest_name, error)) continue;  // none, or one that was under way
    try {
      json manifest = read_manifest(slot(folder, number));
      if (text_in(manifest, "case") != past)
        throw std::runtime_error("it belongs to a case with other settings or data");
      const auto serial = count_in(manifest, "serial");
      found.push_back({serial, number, std::move(manifest)});
    } catch (const std::exception& why) {
      refuse(number, why.what());
    }
  }
  std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.serial > b.serial; });
  for (const Found& one : found) try {
      return read_slot(slot(folder, one.number), one.manifest);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& why) {
      refuse(one.number, why.what());
    }
  return std::nullopt;
}

double bytes_of_checkpoint(const Particles& particles) {
  double columns = 0;
  for_each_column(particles, [&](std::string_view, std::size_t, const auto&) { ++columns; });
  return 8 * columns * static_cast<double>(particles.size());
}

std::vector<fs::path> checkpoint_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const int number : {0, 1}) {
    for (const char* name : {manifest_name, state_file})
      if (fs::exists(slot(folder, number) / name, error)) files.push_back(slot(folder, number) / name);
    for (std::size_t piece = 0; fs::exists(slot(folder, number) / piece_file(piece), error); ++piece)
      files.push_back(slot(folder, number) / piece_file(piece));
  }
  return files;
}

}  // namespace gaussdrift::write
