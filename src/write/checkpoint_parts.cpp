#include "write/checkpoint_parts.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cerrno>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/json_file.hpp"
#include "particle/columns.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

fs::path checkpoint_slot(const fs::path& folder, int number) {
  return folder / checkpoints_folder / std::to_string(number);
}

fs::path piece_file(std::size_t number) { return fmt::format("particles_{:04}.raw", number); }

json columns_of(const Particles& particles) {
  json names = json::array();
  for_each_column(particles, [&](std::string_view name, std::size_t number, const auto&) {
    const bool numbered = name == "position" || name == "path" || name == "kept";
    names.push_back(numbered ? fmt::format("{}_{}", name, number) : std::string(name));
  });
  return names;
}

std::uint64_t sum_of_manifest(const json& manifest) {
  const std::string text = manifest.dump();
  return crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(text.data()), text.size());
}

void refuse_member(const char* name, const char* must_be) {
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

json read_manifest(const fs::path& slot) {
  constexpr std::size_t most_manifest = std::size_t{1} << 28;  // two million pieces
  auto read = base::json_if_there(slot / manifest_name, most_manifest, "it is written anew");
  if (!read) throw std::runtime_error("it has no manifest");
  json manifest = std::move(*read);
  if (member(manifest, "kind") != checkpoint_kind) throw std::runtime_error("its manifest is none of a checkpoint");
  if (const auto written = count_in(manifest, "version"); written > checkpoint_version)
    throw std::runtime_error(fmt::format("it was written by a newer gaussdrift (format {}, this one knows {})", written,
                                         checkpoint_version));
  const auto sum = count_in(manifest, "crc32");
  manifest.erase("crc32");
  if (sum != sum_of_manifest(manifest)) throw std::runtime_error("its manifest is damaged: its check sum is wrong");
  return manifest;
}

RawFile::RawFile(const fs::path& file) : own_(std::fopen(file.c_str(), "rb"), &std::fclose), file_(own_.get()) {
  if (!file_) throw std::system_error(errno, std::generic_category());
}

void RawFile::write(const void* data, std::size_t bytes) {
  add(data, bytes);
  if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes) throw std::system_error(errno, std::generic_category());
}

void RawFile::read(void* data, std::size_t bytes) {
  if (bytes > 0 && std::fread(data, 1, bytes, file_) != bytes) throw std::runtime_error("it is cut short");
  add(data, bytes);
}

void RawFile::add(const void* data, std::size_t bytes) {
  sum_ = crc32_z(sum_, static_cast<const Bytef*>(data), bytes);
  bytes_ += bytes;
}

}  // namespace gaussdrift::write
