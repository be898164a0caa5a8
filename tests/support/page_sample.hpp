#pragma once
// Requirements of every page that we write: well-formed, with unique ids, and readable offline.

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/support/inflated.hpp"

namespace ballast {

/// The data of the page's scripts, as JSON.
inline std::string page_data(const std::string& page) {
  const size_t begin = page.find('>', page.find("id=\"page-data\"")) + 1;
  return inflated(from_base64(page.substr(begin, page.find("</script>", begin) - begin)));
}

/// Checks that elements are closed in the order in which they were opened (except void elements and
/// <x/>). Returns the first fault.
inline std::string nesting_fault(const std::string& page) {
  const std::set<std::string> is_void{"meta", "br", "!DOCTYPE", "img"};
  std::vector<std::string> open;
  for (size_t at = 0; (at = page.find('<', at)) != std::string::npos;) {
    const size_t end = page.find('>', at);
    if (end == std::string::npos) return "no end of " + page.substr(at, 40);
    size_t name_begin = at + 1;
    const bool closes = page[name_begin] == '/';
    if (closes) ++name_begin;
    size_t name_end = name_begin;
    while (name_end < end && !std::isspace(static_cast<unsigned char>(page[name_end])) &&
           page[name_end] != '/')
      ++name_end;
    const std::string name = page.substr(name_begin, name_end - name_begin);
    if (closes) {
      if (open.empty() || open.back() != name)
        return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
      open.pop_back();
    } else if (page[end - 1] != '/' && !is_void.count(name)) {
      open.push_back(name);
    }
    at = end + 1;
    for (const char* raw : {"style", "script"})
      if (!closes && name == raw) at = page.find("</" + name + '>', at);
  }
  return open.empty() ? "" : "open at the end: " + open.back();
}

/// The page without the contents of its scripts.
inline std::string without_scripts(std::string page) {
  for (size_t at = 0; (at = page.find("<script", at)) != std::string::npos; ++at) {
    const size_t begin = page.find('>', at) + 1;
    page.erase(begin, page.find("</script>", begin) - begin);
  }
  return page;
}

inline std::vector<std::string> ids_in(const std::string& whole) {
  const std::string page = without_scripts(whole);
  std::vector<std::string> ids;
  for (size_t at = 0; (at = page.find(" id=", at)) != std::string::npos; ++at) {
    const char quote = page[at + 4];
    ids.push_back(page.substr(at + 5, page.find(quote, at + 5) - at - 5));
  }
  return ids;
}

/// The page without xmlns values, which alone may name a place outside.
inline std::string without_xmlns(std::string page) {
  for (size_t at = 0; (at = page.find("xmlns", at)) != std::string::npos;) {
    const size_t quote = page.find('"', at);
    page.erase(at, page.find('"', quote + 1) + 1 - at);
  }
  return page;
}

inline void check_page(const std::string& page) {
  using Catch::Matchers::Contains;
  CHECK(nesting_fault(page) == "");
  std::vector<std::string> ids = ids_in(page);
  std::sort(ids.begin(), ids.end());
  const auto twice = std::adjacent_find(ids.begin(), ids.end());
  CHECK((twice == ids.end() ? "" : *twice) == "");
  CHECK_THAT(without_xmlns(page), !Contains("http:") && !Contains("https:") &&
                                      !Contains("<script src") && !Contains("@import") &&
                                      !Contains("<link"));
  // Pictures are contained in the page.
  for (size_t at = 0; (at = page.find(" src=", at)) != std::string::npos; ++at)
    CHECK_THAT(page.substr(at, 30), Catch::StartsWith(" src=\"data:image/"));
}

}  // namespace ballast
