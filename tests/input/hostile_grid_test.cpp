// Files of grids that lie about themselves: refused with the place and the reason, before memory is taken for what they
// claim. And every binary form in which honest files come.
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <vector>

#include "grid_files.hpp"

namespace gaussdrift::input {
namespace {

using Bytes = std::string;

template <class Word>
Bytes bytes_of(const std::vector<Word>& words, bool big_endian) {
  Bytes bytes;
  for (const Word& word : words) {
    Bytes one(sizeof(Word), '\0');
    std::memcpy(one.data(), &word, sizeof(Word));
    if (big_endian) std::reverse(one.begin(), one.end());
    bytes += one;
  }
  return bytes;
}

Bytes deflated(const Bytes& bytes) {
  uLongf size = compressBound(bytes.size());
  Bytes packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  packed.resize(size);
  return packed;
}

struct Form {
  bool big_endian = false, long_header = true, zlib = false, base64 = true, appended = false;
};

class HostileGrid : public GridFile {
 protected:
  /// The bytes of an array as a file of this form has them.
  static Bytes array_bytes(const Bytes& data, const Form& form, std::size_t block = 16) {
    const auto header = [&](const std::vector<std::uint64_t>& lengths) {
      return form.long_header ? bytes_of(lengths, form.big_endian)
                              : bytes_of(std::vector<std::uint32_t>(lengths.begin(), lengths.end()), form.big_endian);
    };
    const auto written = [&](const Bytes& bytes) { return form.base64 ? in_base64(bytes) : bytes; };
    if (!form.zlib) return written(header({data.size()}) + data);
    std::vector<std::uint64_t> lengths{(data.size() + block - 1) / block, block, data.size() % block};
    Bytes blocks;
    for (std::size_t at = 0; at < data.size(); at += block) {
      const Bytes packed = deflated(data.substr(at, block));
      lengths.push_back(packed.size());
      blocks += packed;
    }
    return written(header(lengths)) + written(blocks);
  }

  static Bytes root(const Form& form) {
    return fmt::format("<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"{}Endian\" header_type=\"{}\"{}>",
                       form.big_endian ? "Big" : "Little", form.long_header ? "UInt64" : "UInt32",
                       form.zlib ? " compressor=\"vtkZLibDataCompressor\"" : "");
  }

  /// An image of 3 x 2 points with the array rho.
  void write_form(const Form& form, const std::string& type, const Bytes& array,
                  const std::string& extent = "0 2 0 1 0 0", const std::string& offset = "0") const {
    const Bytes head = fmt::format(
        "{}<ImageData WholeExtent=\"{}\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=\"{}\"><PointData>",
        root(form), extent, extent);
    const Bytes tail = "</PointData></Piece></ImageData>";
    std::ofstream file(folder_ / "form.vti", std::ios::binary);
    if (form.appended)
      file << head
           << fmt::format("<DataArray type=\"{}\" Name=\"rho\" format=\"appended\" offset=\"{}\"/>", type, offset)
           << tail << "<AppendedData encoding=\"" << (form.base64 ? "base64" : "raw") << "\">\n   _" << array
           << "</AppendedData></VTKFile>";
    else
      file << head << fmt::format("<DataArray type=\"{}\" Name=\"rho\" format=\"binary\">\n  ", type) << array
           << "\n</DataArray>" << tail << "</VTKFile>";
  }

  void expect_refusal(const std::string& name, const std::string& part) const {
    const std::string text = refusal(name, {});
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
  }
  void write_text(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
};

/// Reads `numbers` of this type back from every form.
template <class Number>
void expect_every_form(const std::function<void(const Form&, const Bytes&)>& write,
                       const std::function<std::vector<double>()>& read,
                       const std::function<Bytes(const Bytes&, const Form&)>& pack,
                       const std::vector<Number>& numbers) {
  for (const bool big_endian : {false, true})
    for (const bool long_header : {false, true})
      for (const bool zlib : {false, true})
        for (const auto& [base64, appended] : {std::pair{true, false}, {true, true}, {false, true}}) {
          const Form form{big_endian, long_header, zlib, base64, appended};
          write(form, pack(bytes_of(numbers, big_endian), form));
          EXPECT_EQ(read(), std::vector<double>(numbers.begin(), numbers.end()))
              << big_endian << long_header << zlib << base64 << appended << " of " << sizeof(Number) << " bytes";
        }
}

TEST_F(HostileGrid, IsAnHonestOneInEveryBinaryFormAndEveryType) {
  const auto check = [&](const std::string& type, auto numbers) {
    using Number = typename decltype(numbers)::value_type;
    expect_every_form<Number>(
        [&](const Form& form, const Bytes& array) { write_form(form, type, array); },
        [&] { return read::read_grid(folder_ / "form.vti", {.missing = read::Missing::keep})->values[0]; },
        [](const Bytes& data, const Form& form) { return array_bytes(data, form); }, numbers);
  };
  const auto whole = [](auto number) {
    using Number = decltype(number);
    using Limits = std::numeric_limits<Number>;
    return std::vector<Number>{Limits::min(), 1, 2, 3, 100, Limits::max()};
  };
  check("Float64", std::vector<double>{1, -2.5, 0.1, 1e-300, 4, 1e300});
  check("Float32", std::vector<float>{1, -2.5f, 0.1f, 1e-30f, 4, 1e30f});
  check("Int8", whole(std::int8_t{}));
  check("UInt8", whole(std::uint8_t{}));
  check("Int16", whole(std::int16_t{}));
  check("UInt16", whole(std::uint16_t{}));
  check("Int32", whole(std::int32_t{}));
  check("UInt32", whole(std::uint32_t{}));
  check("Int64", whole(std::int64_t{}));
  check("UInt64", whole(std::uint64_t{}));
}

TEST_F(HostileGrid, ThatClaimsMoreThanItHasIsRefusedWithItsPlace) {
  const Bytes six = bytes_of(std::vector<double>{1, 2, 3, 4, 5, 6}, false);
  const Form plain, raw{.base64 = false, .appended = true}, packed{.zlib = true};
  const auto lengths = [](const std::vector<std::uint64_t>& words) { return bytes_of(words, false); };
  const Bytes good = array_bytes(six, packed, 48), block = deflated(six);
  const struct {
    Form form;
    Bytes array;
    const char *message, *extent = "0 2 0 1 0 0", *offset = "0";
  } refusals[] = {
      {plain, array_bytes(six, plain), "has more numbers than the 4 that", "0 1 0 1 0 0"},
      {plain, array_bytes(six, plain), "has fewer numbers than the 8 that", "0 3 0 1 0 0"},
      {plain, in_base64(lengths({~0ull}) + six), "claims 18446744073709551615 bytes, more than the file has"},
      {plain, in_base64(lengths({48}) + six.substr(0, 30)), "is damaged: the file ends before its 48 bytes"},
      {plain, in_base64(lengths({49}) + six + "x"), "its 49 bytes are no multiple of 8"},
      {plain, array_bytes(six, plain) + " AAAA", "something stands behind its 48 bytes"},
      {plain, array_bytes(six, plain) + "!", "something stands behind its 48 bytes"},
      {plain, in_base64("1234"), "the file ends within its length"},
      {plain, "", "the file ends within its length"},
      {raw, array_bytes(six, raw), "offset = 1000 lies behind the end", "0 2 0 1 0 0", "1000"},
      {raw, array_bytes(six, raw), "offset = \"-1\", which is no whole number", "0 2 0 1 0 0", "-1"},
      {raw, array_bytes(six, raw), "is no whole number", "0 2 0 1 0 0", "99999999999999999999"},
      {raw, array_bytes(six, raw), "claims to hold 1e+08 numbers in ", "0 9999 0 9999 0 0"},
      {packed, in_base64(lengths({1ull << 61, 48, 0})), "claims 2305843009213693952 blocks"},
      {packed, in_base64(lengths({2, 0, 0, 1, 1})), "its blocks have 0 bytes, the last one 0"},
      {packed, in_base64(lengths({2, 1ull << 63, 0, 1, 1})), "its blocks have 9223372036854775808 bytes"},
      {packed, in_base64(lengths({1, 48, 49, 20})), "its blocks have 48 bytes, the last one 49"},
      {packed, in_base64(lengths({1, 48, 0, ~0ull})), "its blocks are longer than the file"},
      {packed, in_base64(lengths({1, 1000000, 0, 20})) + in_base64(block), "1000000 bytes cannot come out of 20"},
      {packed, in_base64(lengths({1, 48, 0, block.size()})) + in_base64(block.substr(0, 10)), "block 1 of 1 cannot be"},
      {packed, in_base64(lengths({1, 48, 0, 20})) + in_base64(Bytes(20, 'x')), "block 1 of 1 cannot be uncompressed"},
      {packed, in_base64(lengths({1, 48, 0, block.size()})) + in_base64(deflated(six.substr(8))),
       "cannot be uncompressed"},
  };
  write_form(packed, "Float64", good);
  EXPECT_EQ(refusal("form.vti", {}), "");
  for (const auto& one : refusals) {
    write_form(one.form, "Float64", one.array, one.extent, one.offset);
    expect_refusal("form.vti", one.message);
    EXPECT_EQ(refusal("form.vti", {}).rfind("form.vti", 0), 0u);
  }
  for (const char* compressor : {"vtkLZ4DataCompressor", "vtkLZMADataCompressor"}) {
    write_form({}, "Float64", array_bytes(six, {}));
    std::ifstream stream(folder_ / "form.vti");
    std::string text((std::istreambuf_iterator<char>(stream)), {});
    text.insert(text.find(" byte_order"), fmt::format(" compressor=\"{}\"", compressor));
    write_text("form.vti", text);
    expect_refusal("form.vti", fmt::format("form.vti:1: the array \"rho\" is compressed by \"{}\", which is not read\n"
                                           "save the file with the compressor ZLib, or without one",
                                           compressor));
  }
}

TEST_F(HostileGrid, ThatUnpacksToALargeOneOfEqualNumbersIsRefused) {
  const Form packed{.zlib = true, .base64 = false, .appended = true};
  const Bytes zeros(std::size_t{8} << 20, '\0');  // 1 M numbers in some 8 kB
  write_form(packed, "Float64", array_bytes(zeros, packed, zeros.size()), "0 1023 0 1023 0 0");
  EXPECT_EQ(refusal("form.vti", {}), "");
  write_form(packed, "UInt8", array_bytes(zeros, packed, zeros.size()), "0 4095 0 2047 0 0");
  expect_refusal("form.vti", "form.vti claims to hold 8.39e+06 numbers in ");
}

TEST_F(HostileGrid, OfXmlThatIsNoneOfVtksIsRefused) {
  const std::string whole = "0 1 0 1 0 0", values = data(array("rho", 1, "1 2 3 4"));
  const auto nested = [](std::size_t depth) {
    std::string text;
    for (std::size_t k = 0; k < depth; ++k) text += "<a>";
    return text;
  };
  const struct {
    std::string text, message;
  } refusals[] = {
      {"", "form.vti is damaged: line 1: no element found"},
      {"\x7f"
       "ELF",
       "form.vti is damaged: line 1: "},
      {"<VTKFile type=\"ImageData\">\n" + nested(200000),
       "form.vti is damaged: line 2: elements are nested more than 64 deep"},
      {"<VTKFile type=\"" + std::string(5000000, 'x') + "\"/>", "a tag is longer than 1000000 bytes"},
      {"<!DOCTYPE a [<!ENTITY b \"c\">]>\n<VTKFile/>", "a file of data has no DOCTYPE"},
      {"<VTKFile type=\"RectilinearGrid\"><RectilinearGrid/></VTKFile>",
       "is not a file of the kind that its name says"},
      {"<VTKFile type=\"ImageData\"></VTKFile>", "is not a file of the kind that its name says"},
      {"<ImageData/>", "is not a file of the kind that its name says"},
      {"<VTKFile><ImageData><AppendedData>_", "<AppendedData> stands inside of another element"},
      {"<VTKFile><AppendedData>x_", "do not begin with an underscore"},
      {"<VTKFile type=\"ImageData\" byte_order=\"Middle\"><ImageData/></VTKFile>",
       "byte_order = \"Middle\" is not known"},
      {"<VTKFile type=\"ImageData\" header_type=\"Int8\"><ImageData/></VTKFile>",
       "header_type = \"Int8\" is not known"},
      {"<VTKFile type=\"ImageData\"><ImageData/><AppendedData encoding=\"rot13\">_",
       "encoding = \"rot13\" is not known"},
      {"<VTKFile type=\"ImageData\"><ImageData/></VTKFile>", "this <ImageData> has no WholeExtent"},
      {"<VTKFile type=\"ImageData\">\xff</VTKFile>", "form.vti is damaged: line 1: not well-formed"},
  };
  for (const auto& one : refusals) {
    write_text("form.vti", one.text);
    expect_refusal("form.vti", one.message);
  }
  for (const auto& [attributes, message] :
       {std::pair{"type=\"String\"", "has no array \"rho\""},
        {"type=\"Bit\"", "does not hold numbers: its type is \"Bit\""},
        {"", "does not hold numbers: its type is nothing"},
        {"type=\"Float64\" format=\"appended\"", "is appended, but it has no offset"},
        {"type=\"Float64\" format=\"appended\" offset=\"0\"", "there is no <AppendedData>"},
        {"type=\"Float64\" format=\"xdr\"", "has the format \"xdr\"\nknown formats: ascii"}}) {
    write_image("form.vti", 2, 2,
                fmt::format("<PointData><DataArray Name=\"rho\" {}>1 2 3 4</DataArray></PointData>", attributes));
    EXPECT_NE(refusal("form.vti", {.arrays = {"rho"}}).find(message), std::string::npos)
        << refusal("form.vti", {.arrays = {"rho"}});
  }
}

TEST_F(HostileGrid, MayHaveAHundredThousandArraysOrPiecesAndIsAnsweredAtOnce) {
  std::string arrays, pieces;
  for (int k = 0; k < 20000; ++k) arrays += fmt::format("<DataArray Name=\"a{}\"/>", k);
  write_image("many.vti", 2, 2, "<PointData>" + arrays + "</PointData>");
  const std::string text = refusal("many.vti", {});
  EXPECT_NE(text.find("\"a0\" (1 component)"), std::string::npos);
  EXPECT_NE(text.find("and 19980 more"), std::string::npos);
  EXPECT_LT(text.size(), 2000u);
  for (int k = 0; k < 20000; ++k) pieces += "<Piece Extent=\"0 1000 0 1000 0 0\"/>";
  write_pieces("many.vti", "0 1000 0 1000 0 0", "", pieces);
  expect_refusal("many.vti", "it has no arrays with names");
  pieces.clear();
  for (int k = 0; k < 3000; ++k)  // the same bytes for all of them
    pieces +=
        "<Piece Extent=\"0 1000 0 1000 0 0\"><PointData><DataArray type=\"UInt8\" Name=\"a\" format=\"appended\" "
        "offset=\"0\"/></PointData></Piece>";
  write_text("many.vti", "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1000 0 1000 0 0\">" + pieces +
                             "</ImageData><AppendedData encoding=\"raw\">_" +
                             bytes_of(std::vector<std::uint32_t>{1002001}, false) + std::string(1002001, '\1'));
  expect_refusal("many.vti", "many.vti claims to hold ");
}

TEST_F(HostileGrid, OfPiecesThatOverlapHasTheSameNumbersInThem) {
  const auto piece = [&](const std::string& extent, const std::string& values) {
    return "<Piece Extent=\"" + extent + "\">" + data(array("rho", 1, values)) + "</Piece>\n";
  };
  const std::string whole = "0 2 0 1 0 0", left = "0 1 0 1 0 0", right = "1 2 0 1 0 0";
  const auto written = [&](const std::string& pieces) {
    write_pieces("image.vti", whole, "", pieces);
    return refusal("image.vti", {});
  };
  EXPECT_EQ(written(piece(whole, "1 2 3 4 5 6") + piece(left, "1 2 4 5")), "");
  EXPECT_NE(written(piece(whole, "1 2 3 4 5 6") + piece(left, "1 2 4 7"))
                .find("the pieces of image.vti overlap and have different numbers there in \"rho\""),
            std::string::npos);
  // Of points at a border the later piece's counts, as in VTK.
  EXPECT_EQ(written(piece(left, "1 2 4 5") + piece(right, "2.5 3 5 6")), "");
  EXPECT_EQ(read::read_grid(folder_ / "image.vti", {})->values[0], (std::vector<double>{1, 2.5, 3, 4, 5, 6}));
}

TEST_F(HostileGrid, OfCoordinatesHasThemAlongThreeAxes) {
  const auto grid = [&](const std::string& axes) {
    write_text("grid.vtr",
               "<VTKFile type=\"RectilinearGrid\"><RectilinearGrid WholeExtent=\"0 1 0 1 0 0\"><Piece Extent=\"0 1 0 1 "
               "0 0\">" +
                   data(array("rho", 1, "1 2 3 4")) + "<Coordinates>" + axes +
                   "</Coordinates></Piece></RectilinearGrid></VTKFile>");
    return refusal("grid.vtr", {});
  };
  const std::string x = array("x", 1, "0 1"), z = array("z", 1, "0");
  EXPECT_EQ(grid(x + x + z), "");
  EXPECT_NE(grid(x + x).find("has coordinates along 2 axes, not along 3"), std::string::npos);
  EXPECT_NE(grid(x + array("y", 2, "0 1 0 1") + z).find("coordinates have one component, not 2"), std::string::npos);
  EXPECT_NE(grid(x + array("y", 1, "0 nan") + z).find("the y coordinate of point 2 of grid.vtr is nan"),
            std::string::npos);
  EXPECT_NE(grid(x + array("y", 1, "0") + z).find("has fewer numbers than the 2"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::input
