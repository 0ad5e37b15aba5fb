// SPDX-License-Identifier: GPL-3.0-or-later

// The Polygon File Format after Greg Turk (1994): ASCII and binary of either byte order. Elements
// and properties that are not polygons are skipped.

#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "exactcsg/io/mesh/mesh_readers.hpp"
#include "exactcsg/io/mesh/text_scanner.hpp"

namespace exactcsg::io {

namespace {

enum class Encoding { Ascii, LittleEndian, BigEndian };
enum class Scalar { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

struct ScalarName {
  std::string_view name;
  Scalar scalar;
};
constexpr std::array<ScalarName, 16> scalar_names = {{{"char", Scalar::Int8},
                                                      {"int8", Scalar::Int8},
                                                      {"uchar", Scalar::UInt8},
                                                      {"uint8", Scalar::UInt8},
                                                      {"short", Scalar::Int16},
                                                      {"int16", Scalar::Int16},
                                                      {"ushort", Scalar::UInt16},
                                                      {"uint16", Scalar::UInt16},
                                                      {"int", Scalar::Int32},
                                                      {"int32", Scalar::Int32},
                                                      {"uint", Scalar::UInt32},
                                                      {"uint32", Scalar::UInt32},
                                                      {"float", Scalar::Float32},
                                                      {"float32", Scalar::Float32},
                                                      {"double", Scalar::Float64},
                                                      {"float64", Scalar::Float64}}};

constexpr std::size_t size_of(Scalar scalar) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(scalar)];
}
constexpr bool is_integer(Scalar scalar) { return scalar < Scalar::Float32; }

struct Property {
  std::string name;
  Scalar scalar = Scalar::Float32;
  std::optional<Scalar> list_count;
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};
struct Header {
  Encoding encoding = Encoding::Ascii;
  std::vector<Element> elements;
};

Scalar scalar(TextScanner& scanner) {
  const std::string_view word = scanner.word("a type");
  for (const auto& [name, scalar] : scalar_names) {
    if (word == name) return scalar;
  }
  scanner.unexpected(word, "a type such as float or uchar");
}

void read_property(TextScanner& scanner, Element& element) {
  Property& property = element.properties.emplace_back();
  TextScanner ahead = scanner;
  if (ahead.word("a type") == "list") {
    scanner = ahead;
    property.list_count = scalar(scanner);
    if (!is_integer(*property.list_count)) scanner.unexpected("a float", "an integer type");
  }
  property.scalar = scalar(scanner);
  property.name = scanner.word("the property's name");
}

Header read_header(TextScanner& scanner) {
  if (scanner.word("ply") != "ply") {
    scanner.fail(ErrorId::UnknownFormat, "a file that does not begin with ply", "ply");
  }
  Header header;
  scanner.keyword("format");
  const std::string_view format = scanner.word("ascii, binary_little_endian or binary_big_endian");
  if (format == "binary_little_endian") {
    header.encoding = Encoding::LittleEndian;
  } else if (format == "binary_big_endian") {
    header.encoding = Encoding::BigEndian;
  } else if (format != "ascii") {
    scanner.unexpected(format, "ascii, binary_little_endian or binary_big_endian");
  }
  scanner.keyword("1.0");
  for (;;) {
    const std::string_view word = scanner.word("end_header");
    if (word == "end_header") break;
    if (word == "comment" || word == "obj_info") {
      scanner.skip_line();
    } else if (word == "element") {
      Element& element = header.elements.emplace_back();
      element.name = scanner.word("the element's name");
      element.count = scanner.count("the number of elements");
    } else if (word == "property" && !header.elements.empty()) {
      read_property(scanner, header.elements.back());
    } else {
      scanner.unexpected(word, "element, property, comment or end_header");
    }
  }
  scanner.skip_line();
  return header;
}

// Both value sources: exact numbers one after the other.
class AsciiValues {
 public:
  explicit AsciiValues(TextScanner& scanner) : scanner_(scanner) {}

  Rational coordinate(Scalar, CoordinateSurvey& survey) { return scanner_.coordinate(survey); }
  std::uint64_t count(Scalar) { return scanner_.count("the length of a list"); }
  std::uint32_t index(Scalar, std::size_t size) { return scanner_.index(size); }
  void skip(Scalar) { scanner_.skip_number("a number"); }
  void end() {
    if (!scanner_.at_end()) scanner_.unexpected(scanner_.word(""), "the end of the file");
  }
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected) const {
    scanner_.fail(id, std::move(found), std::move(expected));
  }

 private:
  TextScanner& scanner_;
};

class BinaryValues {
 public:
  BinaryValues(std::string_view bytes, std::size_t at, bool big_endian, const std::string& file)
      : bytes_(bytes), at_(at), big_endian_(big_endian), file_(file) {}

  Rational coordinate(Scalar scalar, CoordinateSurvey& survey) {
    const std::uint64_t bits = take(scalar);
    Rational value;
    if (is_integer(scalar)) {
      value = Rational(static_cast<long>(signed_value(scalar, bits)));
    } else {
      const double number = scalar == Scalar::Float32
                                ? double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))}
                                : std::bit_cast<double>(bits);
      if (!std::isfinite(number) || std::abs(number) > 1e100) {
        fail(ErrorId::NumberOutOfRange, "a coordinate that is not finite or beyond 1e100",
             "a finite coordinate");
      }
      value = exactcsg::rational_of(number);
    }
    survey.note(value);
    return value;
  }
  std::uint64_t count(Scalar scalar) {
    const std::int64_t value = signed_value(scalar, take(scalar));
    if (value < 0) fail(ErrorId::UnexpectedText, "a list of negative length", "a length");
    return static_cast<std::uint64_t>(value);
  }
  std::uint32_t index(Scalar scalar, std::size_t size) {
    const std::int64_t value = signed_value(scalar, take(scalar));
    if (value < 0 || static_cast<std::uint64_t>(value) >= size) {
      fail(ErrorId::UnknownVertex, "vertex " + std::to_string(value),
           "one of " + std::to_string(size) + " vertices");
    }
    return static_cast<std::uint32_t>(value);
  }
  void skip(Scalar scalar) { take(scalar); }
  void end() {
    if (at_ != bytes_.size()) {
      fail(ErrorId::UnexpectedText, std::to_string(bytes_.size() - at_) + " more bytes",
           "the end of the file");
    }
  }
  [[noreturn]] void fail(ErrorId id, std::string found, std::string expected) const {
    throw Error(id, {std::move(found) + " at byte " + std::to_string(at_), std::move(expected),
                     SourcePosition{file_}});
  }

 private:
  std::uint64_t take(Scalar scalar) {
    const std::size_t size = size_of(scalar);
    if (bytes_.size() - at_ < size) {
      fail(ErrorId::TruncatedInput, "the end of the file", "more elements");
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t shift = 8 * (big_endian_ ? size - 1 - i : i);
      bits |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[at_ + i])) << shift;
    }
    at_ += size;
    return bits;
  }
  static std::int64_t signed_value(Scalar scalar, std::uint64_t bits) {
    switch (scalar) {
      case Scalar::Int8:
        return static_cast<std::int8_t>(bits);
      case Scalar::Int16:
        return static_cast<std::int16_t>(bits);
      case Scalar::Int32:
        return static_cast<std::int32_t>(bits);
      default:
        return static_cast<std::int64_t>(bits);
    }
  }

  std::string_view bytes_;
  std::size_t at_;
  bool big_endian_;
  const std::string& file_;
};

template <class Values>
void read_vertices(const Element& element, Values& values, CoordinateSurvey& survey,
                   PolygonSoup& soup) {
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Point3& p = soup.vertices.emplace_back();
    for (const Property& property : element.properties) {
      Rational* const coordinate = property.name == "x"   ? &p.x
                                   : property.name == "y" ? &p.y
                                   : property.name == "z" ? &p.z
                                                          : nullptr;
      if (property.list_count) {
        for (std::uint64_t n = values.count(*property.list_count); n > 0; --n) {
          values.skip(property.scalar);
        }
      } else if (coordinate != nullptr) {
        *coordinate = values.coordinate(property.scalar, survey);
      } else {
        values.skip(property.scalar);
      }
    }
  }
}

bool is_facet_list(const Property& property) {
  return property.list_count && is_integer(property.scalar) &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

// Of any element but vertices; the lists of vertices are facets.
template <class Values>
void read_others(const Element& element, std::size_t vertices, Values& values, PolygonSoup& soup) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) {
      std::uint64_t length = property.list_count ? values.count(*property.list_count) : 1;
      if (element.name != "face" || !is_facet_list(property)) {
        for (; length > 0; --length) values.skip(property.scalar);
        continue;
      }
      if (length < 3) {
        values.fail(ErrorId::UnexpectedText, "a facet of " + std::to_string(length) + " vertices",
                    "at least 3 vertices");
      }
      auto& facet = soup.facets.emplace_back();
      for (; length > 0; --length) facet.push_back(values.index(property.scalar, vertices));
    }
  }
}

const Element& vertex_element(const Header& header, const TextScanner& scanner) {
  for (const Element& element : header.elements) {
    if (element.name != "vertex") continue;
    int axes = 0;
    for (const Property& property : element.properties) {
      const bool axis = property.name == "x" || property.name == "y" || property.name == "z";
      axes += axis && !property.list_count ? 1 : 0;
    }
    if (axes == 3) return element;
  }
  scanner.fail(ErrorId::UnexpectedText, "no element vertex with properties x, y and z", "one");
}

template <class Values>
void read_body(const Header& header, const Element& vertices, Values& values,
               CoordinateSurvey& survey, PolygonSoup& soup) {
  for (const Element& element : header.elements) {
    if (&element == &vertices) {
      read_vertices(element, values, survey, soup);
    } else {
      read_others(element, vertices.count, values, soup);
    }
  }
  values.end();
}

Rational rounding_bound(const Header& header, const Element& vertices,
                        const CoordinateSurvey& survey) {
  if (header.encoding == Encoding::Ascii) return text_rounding_bound(survey);
  for (const Property& property : vertices.properties) {
    if (property.name == "x" && property.scalar == Scalar::Float64) {
      return half_binary_unit(survey.largest, 53);
    }
  }
  return half_binary_unit(survey.largest, 24);
}

}  // namespace

PolygonSoup read_ply(std::string_view bytes, const std::string& file) {
  TextScanner scanner(bytes, file, '\0');
  const Header header = read_header(scanner);
  const Element& vertices = vertex_element(header, scanner);
  PolygonSoup soup;
  soup.format = MeshFormat::Ply;
  CoordinateSurvey survey;
  if (header.encoding == Encoding::Ascii) {
    AsciiValues values(scanner);
    read_body(header, vertices, values, survey, soup);
  } else {
    BinaryValues values(bytes, scanner.offset(), header.encoding == Encoding::BigEndian, file);
    read_body(header, vertices, values, survey, soup);
  }
  soup.rounding_bound = rounding_bound(header, vertices, survey);
  return soup;
}

}  // namespace exactcsg::io
