#include "platform/deflate.hpp"

#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/support/inflated.hpp"

using namespace ballast;

TEST_CASE("what was packed comes back, at every level") {
  std::string noise;
  Random random(5);
  for (int k = 0; k < 5000; ++k) noise += static_cast<char>(random.uniform(0.0, 255.99));
  for (const std::string& bytes :
       {std::string(), std::string("a"), std::string(1 << 20, 'z'), noise})
    for (const int level : {1, 6, 9}) CHECK(inflated(deflated(bytes, level)) == bytes);
  CHECK(deflated(std::string(1 << 20, 'z')).size() < 2000);
}

TEST_CASE("the check sum of PNG files") {
  CHECK(crc32_of("123456789") == 0xcbf43926u);  // the check value of this polynomial
  CHECK(crc32_of("IEND") == 0xae426082u);       // the one at the end of every PNG
}

// The examples of RFC 4648, section 10, and bytes that are not text.
TEST_CASE("bytes as base64") {
  CHECK(base64("").empty());
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foobar") == "Zm9vYmFy");
  CHECK(base64(std::string("\0\xff\xfe", 3)) == "AP/+");
}
