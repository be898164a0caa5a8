#pragma once
// Enough of an XML reader to check what we write for ParaView.

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "tests/catch.hpp"

namespace ballast {

struct XmlElement {
  std::string name, text;
  std::map<std::string, std::string> attributes;
};

/// All elements in the order of their opening tags. Fails the test unless the text is well-formed:
/// one root, every tag closed in order, attributes quoted.
inline std::vector<XmlElement> parse_xml(const std::string& xml) {
  std::vector<XmlElement> elements;
  std::vector<size_t> open;
  size_t at = 0;
  REQUIRE(xml.rfind("<?xml version=\"1.0\"?>\n", 0) == 0);
  at = xml.find('\n') + 1;
  int roots = 0;
  while (at < xml.size()) {
    const size_t tag = xml.find('<', at);
    const std::string between = xml.substr(at, tag - at);
    REQUIRE(between.find_first_of(">&") == std::string::npos);
    if (open.empty())
      REQUIRE(between.find_first_not_of("\n ") == std::string::npos);
    else
      elements[open.back()].text += between;
    if (tag == std::string::npos) break;
    const size_t end = xml.find('>', tag);
    REQUIRE(end != std::string::npos);
    std::string inside = xml.substr(tag + 1, end - tag - 1);
    at = end + 1;
    if (inside[0] == '/') {
      REQUIRE((!open.empty() && elements[open.back()].name == inside.substr(1)));
      open.pop_back();
      continue;
    }
    const bool closed = inside.back() == '/';
    if (closed) inside.pop_back();
    XmlElement element;
    size_t position = inside.find(' ');
    element.name = inside.substr(0, position);
    while (position != std::string::npos) {
      const size_t equals = inside.find("=\"", position), quote = inside.find('"', equals + 2);
      REQUIRE((equals != std::string::npos && quote != std::string::npos));
      const std::string name = inside.substr(position + 1, equals - position - 1);
      REQUIRE(
          element.attributes.emplace(name, inside.substr(equals + 2, quote - equals - 2)).second);
      position = inside.find(' ', quote);
    }
    if (open.empty()) ++roots;
    elements.push_back(element);
    if (!closed) open.push_back(elements.size() - 1);
  }
  REQUIRE((open.empty() && roots == 1));
  return elements;
}

inline std::string decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  REQUIRE(text.size() % 4 == 0);
  for (size_t at = 0; at < text.size(); at += 4) {
    std::uint32_t group = 0;
    int given = 0;
    for (size_t k = 0; k < 4; ++k) {
      const size_t digit = digits.find(text[at + k]);
      if (text[at + k] != '=')
        REQUIRE((digit != std::string::npos && given == static_cast<int>(k)));
      given += text[at + k] != '=';
      group = group << 6 | (text[at + k] == '=' ? 0u : static_cast<std::uint32_t>(digit));
    }
    for (int k = 0; k < given - 1; ++k) bytes += static_cast<char>(group >> (16 - 8 * k));
  }
  return bytes;
}

/// The numbers of the DataArray of that name: an UInt64 count of bytes, then the bytes.
template <class Number>
std::vector<Number> vtk_array(const std::vector<XmlElement>& elements, const std::string& name) {
  for (const XmlElement& element : elements) {
    const auto found = element.attributes.find("Name");
    if (element.name != "DataArray" || found == element.attributes.end() || found->second != name)
      continue;
    REQUIRE(element.attributes.at("type") == (std::is_same_v<Number, float> ? "Float32" : "Int32"));
    const std::string bytes = decode_base64(element.text);
    std::uint64_t length = 0;
    REQUIRE(bytes.size() >= sizeof length);
    std::memcpy(&length, bytes.data(), sizeof length);
    REQUIRE(bytes.size() == sizeof length + length);
    std::vector<Number> values(length / sizeof(Number));
    if (length > 0) std::memcpy(values.data(), bytes.data() + sizeof length, length);
    return values;
  }
  FAIL("no DataArray " << name);
  return {};
}

}  // namespace ballast
