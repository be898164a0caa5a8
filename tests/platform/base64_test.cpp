#include "platform/base64.hpp"

#include "tests/catch.hpp"

using ballast::base64;

// The examples of RFC 4648, section 10, and bytes that are no text.
TEST_CASE("bytes as base64") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64(std::string("\0\xff\xfe", 3)) == "AP/+");
}
