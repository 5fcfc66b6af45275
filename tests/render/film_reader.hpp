// Reads films from their bytes, by the descriptions of the formats [GIF89] [PNG25] and by nothing of the program.
#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift {

struct ReadFilm {
  int width = 0, height = 0;
  std::vector<std::vector<std::array<std::uint8_t, 3>>> frames;  // whole pictures, from the upper left
  std::vector<double> seconds;                                   // that each is shown
  bool for_ever = false;
};

/// Bytes from the front of a text.
class Bytes {
 public:
  explicit Bytes(std::string_view left) : left_(left) {}
  std::string_view take(std::size_t count) {
    if (count > left_.size()) throw std::runtime_error("the film ends too soon");
    const std::string_view part = left_.substr(0, count);
    left_.remove_prefix(count);
    return part;
  }
  std::size_t byte() { return static_cast<unsigned char>(take(1)[0]); }
  std::size_t low_first() {
    const std::size_t low = byte();
    return low + 256 * byte();
  }
  std::size_t high_first(int count) {
    std::size_t number = 0;
    for (int i = 0; i < count; ++i) number = 256 * number + byte();
    return number;
  }
  bool at_end() const { return left_.empty(); }

 private:
  std::string_view left_;
};

/// Numbers of colours from the codes of a GIF, whose table begins anew at each clear code.
inline std::vector<std::uint8_t> unpacked_gif(const std::string& codes, unsigned bits) {
  const unsigned clear = 1u << bits, end = clear + 1;
  std::vector<std::vector<std::uint8_t>> table;
  unsigned width = bits + 1, have = 0, buffer = 0;
  std::vector<std::uint8_t> pixels, before;
  const auto begin_anew = [&] {
    table.assign(clear + 2, {});
    for (unsigned i = 0; i < clear; ++i) table[i] = {static_cast<std::uint8_t>(i)};
    width = bits + 1;
    before.clear();
  };
  begin_anew();
  for (std::size_t at = 0;;) {
    while (have < width) {
      if (at == codes.size()) throw std::runtime_error("codes end too soon");
      buffer |= static_cast<unsigned>(static_cast<unsigned char>(codes[at++])) << have, have += 8;
    }
    const unsigned code = buffer & ((1u << width) - 1);
    buffer >>= width, have -= width;
    if (code == end) return pixels;
    if (code == clear) {
      begin_anew();
      continue;
    }
    std::vector<std::uint8_t> now;
    if (code < table.size())
      now = table[code];
    else if (code == table.size() && !before.empty())
      now = before, now.push_back(before.front());
    else
      throw std::runtime_error("a code is not known yet");
    pixels.insert(pixels.end(), now.begin(), now.end());
    if (!before.empty() && table.size() < 4096) {
      before.push_back(now.front());
      table.push_back(before);
      if (table.size() == 1u << width && width < 12) ++width;
    }
    before = now;
  }
}

inline ReadFilm read_gif(const std::string& file) {
  Bytes in(file);
  ReadFilm film;
  if (in.take(6) != "GIF89a") throw std::runtime_error("no GIF89a");
  film.width = static_cast<int>(in.low_first()), film.height = static_cast<int>(in.low_first());
  const std::size_t flags = in.byte();
  in.take(2);
  const std::string_view colours = in.take(3u << ((flags & 7) + 1));
  std::vector<std::array<std::uint8_t, 3>> shown(static_cast<std::size_t>(film.width * film.height));
  const auto blocks = [&] {
    std::string all;
    while (const std::size_t size = in.byte()) all += in.take(size);
    return all;
  };
  std::size_t transparent = 256;
  while (true) {
    const std::size_t what = in.byte();
    if (what == ';') {
      if (!in.at_end()) throw std::runtime_error("there is more after the end");
      return film;
    }
    if (what == '!') {
      const std::size_t kind = in.byte();
      const std::string data = blocks();
      if (kind == 0xF9) {
        Bytes control(data);
        transparent = control.byte() & 1 ? 1 : 256;
        film.seconds.push_back(static_cast<double>(control.low_first()) / 100);
        if (transparent == 1) transparent = control.byte();
      } else if (data.starts_with("NETSCAPE2.0")) {
        film.for_ever = data.substr(11) == std::string("\x01\0\0", 3);
      }
      continue;
    }
    if (what != ',') throw std::runtime_error("an unknown part");
    const std::size_t left = in.low_first(), top = in.low_first(), columns = in.low_first(), rows = in.low_first();
    if (in.byte() != 0) throw std::runtime_error("an own table of colours");
    const auto bits = static_cast<unsigned>(in.byte());
    const auto pixels = unpacked_gif(blocks(), bits);
    if (pixels.size() != columns * rows) throw std::runtime_error("a frame has not as many pixels as it should");
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (pixels[i] == transparent) continue;
      auto& pixel = shown.at((top + i / columns) * static_cast<std::size_t>(film.width) + left + i % columns);
      for (std::size_t k = 0; k < 3; ++k) pixel[k] = static_cast<std::uint8_t>(colours.at(3u * pixels[i] + k));
    }
    film.frames.push_back(shown);
  }
}

/// Rows of a PNG without their filters, of so many bytes a pixel.
inline std::string unfiltered(const std::string& packed, std::size_t columns, std::size_t rows, std::size_t bytes) {
  std::string raw(rows * (1 + columns * bytes), '\0');
  uLongf size = raw.size();
  if (uncompress(reinterpret_cast<Bytef*>(raw.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                 packed.size()) != Z_OK ||
      size != raw.size())
    throw std::runtime_error("the pixels of a frame are damaged");
  std::string pixels(rows * columns * bytes, '\0');
  const auto at = [&](std::size_t row, std::size_t i) -> unsigned char {
    return static_cast<unsigned char>(pixels[row * columns * bytes + i]);
  };
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < columns * bytes; ++i) {
      const int left = i < bytes ? 0 : at(row, i - bytes), above = row == 0 ? 0 : at(row - 1, i);
      const int corner = i < bytes || row == 0 ? 0 : at(row - 1, i - bytes), guess = left + above - corner;
      const int to_left = std::abs(guess - left), to_above = std::abs(guess - above),
                to_corner = std::abs(guess - corner);
      const std::array<int, 5> predicted{0, left, above, (left + above) / 2,
                                         to_left <= to_above && to_left <= to_corner ? left
                                         : to_above <= to_corner                     ? above
                                                                                     : corner};
      pixels[row * columns * bytes + i] =
          static_cast<char>(raw[row * (1 + columns * bytes) + 1 + i] +
                            predicted.at(static_cast<unsigned char>(raw[row * (1 + columns * bytes)])));
    }
  return pixels;
}

/// All colours, opaque. A single picture is a film of one frame.
inline ReadFilm read_apng(const std::string& file) {
  Bytes in(file);
  ReadFilm film;
  if (in.take(8) != std::string_view("\x89PNG\r\n\x1a\n", 8)) throw std::runtime_error("no PNG");
  std::vector<std::array<std::uint8_t, 3>> shown;
  std::size_t columns = 0, rows = 0, left = 0, top = 0, sequence = 0, announced = 1;
  const auto show = [&](const std::string& packed) {
    const std::string pixels = unfiltered(packed, columns, rows, 3);
    for (std::size_t i = 0; i < columns * rows; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        shown.at((top + i / columns) * static_cast<std::size_t>(film.width) + left + i % columns)[k] =
            static_cast<std::uint8_t>(pixels[3 * i + k]);
    film.frames.push_back(shown);
  };
  const auto next_in_sequence = [&](Bytes& data) {
    if (data.high_first(4) != sequence++) throw std::runtime_error("a part is out of sequence");
  };
  while (true) {
    const std::size_t size = in.high_first(4);
    const std::string type_and_data(in.take(size + 4));
    if (in.high_first(4) !=
        crc32(0, reinterpret_cast<const Bytef*>(type_and_data.data()), static_cast<uInt>(type_and_data.size())))
      throw std::runtime_error("a check sum is wrong");
    const std::string type = type_and_data.substr(0, 4);
    Bytes data(std::string_view(type_and_data).substr(4));
    if (type == "IHDR") {
      columns = data.high_first(4), rows = data.high_first(4);
      film.width = static_cast<int>(columns), film.height = static_cast<int>(rows);
      if (data.byte() != 8 || data.byte() != 2) throw std::runtime_error("other pixels than 8 bits of three colours");
      shown.resize(columns * rows);
    } else if (type == "acTL") {
      announced = data.high_first(4), film.for_ever = data.high_first(4) == 0;
    } else if (type == "fcTL") {
      next_in_sequence(data);
      columns = data.high_first(4), rows = data.high_first(4), left = data.high_first(4), top = data.high_first(4);
      const auto above = static_cast<double>(data.high_first(2));
      film.seconds.push_back(above / static_cast<double>(data.high_first(2)));
      if (data.high_first(2) != 0) throw std::runtime_error("a frame that does not stay");
    } else if (type == "IDAT") {
      show(type_and_data.substr(4));
    } else if (type == "fdAT") {
      next_in_sequence(data);
      show(type_and_data.substr(8));
    } else if (type == "IEND") {
      if (film.frames.size() != announced || !in.at_end()) throw std::runtime_error("frames are missing");
      return film;
    } else {
      throw std::runtime_error("an unknown part: " + type);
    }
  }
}

}  // namespace gaussdrift
