#pragma once
// A headless browser for tests of pages: Debian's chromium, controlled by the DevTools protocol
// over two pipes (its --remote-debugging-pipe: JSON messages that end in a zero byte), without a
// driver or a port. It has no network. All tests in one process share one program, and each has its
// own tab.

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "platform/program.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {

/// The browser's process, and the messages to and from it.
class BrowserProgram {
 public:
  using Json = nlohmann::json;
  static constexpr const char* path = "/usr/bin/chromium";

  explicit BrowserProgram(const std::vector<std::string>& switches) {
    std::array<int, 2> to{}, from{};
    if (pipe2(to.data(), O_CLOEXEC) != 0 || pipe2(from.data(), O_CLOEXEC) != 0)
      throw std::runtime_error("no pipe");
    std::vector<std::string> words{
        path,
        "--headless=new",
        "--no-sandbox",
        "--disable-dev-shm-usage",  // it is small in a container
        "--remote-debugging-pipe",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--ignore-gpu-blocklist",
        "--disable-gpu-rasterization",      // 2D on the processor: no
        "--disable-accelerated-2d-canvas",  // detour by a GPU in software
        "--hide-scrollbars",
        "--disable-background-networking",
        "--user-data-dir=" + profile_.path().string()};
    words.insert(words.end(), switches.begin(), switches.end());
    child_.emplace([&] {
      // The browser reads from 3 and writes to 4, whatever descriptors the pipes have.
      const int in = fcntl(to[0], F_DUPFD, 10), out = fcntl(from[1], F_DUPFD, 10);
      dup2(in, 3);
      dup2(out, 4);
      const int nowhere = ::open("/dev/null", O_RDWR);
      for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      execv(path, arguments.data());
    });
    close(to[0]);
    close(from[1]);
    write_ = to[1];
    read_ = from[0];
  }
  ~BrowserProgram() {
    for (const int end : {write_, read_}) close(end);
  }
  BrowserProgram(const BrowserProgram&) = delete;
  BrowserProgram& operator=(const BrowserProgram&) = delete;

  /// The answer to a command. `note` gets the events that come before it. `session`: that of a tab,
  /// or empty.
  template <typename Note>
  Json call(const std::string& session, const std::string& method, const Json& parameters,
            const Note& note) {
    Json message{{"id", ++count_}, {"method", method}, {"params", parameters}};
    if (!session.empty()) message["sessionId"] = session;
    std::string text = message.dump();
    text += '\0';
    for (size_t sent = 0; sent < text.size();) {
      const ssize_t now = write(write_, text.data() + sent, text.size() - sent);
      if (now <= 0) throw std::runtime_error(method + ": the browser is gone");
      sent += static_cast<size_t>(now);
    }
    for (;;) {
      const Json answer = Json::parse(next_message(method));
      if (answer.value("id", 0) == count_) {
        if (answer.contains("error"))
          throw std::runtime_error(method + ": " + answer.at("error").dump());
        return answer.at("result");
      }
      note(answer);
    }
  }

 private:
  std::string next_message(const std::string& method) {
    for (;;) {
      const size_t end = received_.find('\0');
      if (end != std::string::npos) {
        const std::string message = received_.substr(0, end);
        received_.erase(0, end + 1);
        return message;
      }
      pollfd ready{read_, POLLIN, 0};
      std::array<char, 65536> bytes{};
      if (poll(&ready, 1, 60000) <= 0) throw std::runtime_error(method + ": no answer");
      const ssize_t got = read(read_, bytes.data(), bytes.size());
      if (got <= 0) throw std::runtime_error(method + ": the browser has ended");
      received_.append(bytes.data(), static_cast<size_t>(got));
    }
  }

  const TemporaryFolder profile_;
  std::optional<ChildProcess> child_;
  int write_ = -1, read_ = -1, count_ = 0;
  std::string received_;
};

/// A tab of the browser.
class Browser {
 public:
  using Json = BrowserProgram::Json;

  /// True without the browser: the tests are then skipped. ctest recognises this message.
  static bool is_missing() {
    if (std::filesystem::exists(BrowserProgram::path)) return false;
    WARN("skipped: " << BrowserProgram::path << " is not installed (apt-packages-browser.txt)");
    return true;
  }

  /// With `switches` for the program it has a process of its own, which need not be able to draw.
  explicit Browser(int width, int height, bool is_dark = false,
                   const std::vector<std::string>& switches = {})
      : program_(switches.empty() ? shared() : std::make_shared<BrowserProgram>(switches)),
        can_draw_(switches.empty()) {
    tab_ = call("Target.createTarget", {{"url", "about:blank"}}).at("targetId");
    session_ =
        call("Target.attachToTarget", {{"targetId", tab_}, {"flatten", true}}).at("sessionId");
    for (const char* domain : {"Page", "Runtime", "Log", "Network"})
      call(std::string(domain) + ".enable");
    call("Network.emulateNetworkConditions",
         {{"offline", true}, {"latency", 0}, {"downloadThroughput", 0}, {"uploadThroughput", 0}});
    look(width, height, is_dark);
  }
  /// Sets the size of the window and whether its user prefers dark pages.
  void look(int width, int height, bool is_dark) {
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
    call("Emulation.setEmulatedMedia",
         {{"features",
           {{{"name", "prefers-color-scheme"}, {"value", is_dark ? "dark" : "light"}}}}});
  }
  /// In any test, a page that can draw must not have written complaints.
  ~Browser() {
    if (can_draw_) CHECK(complaints_ == std::vector<std::string>{});
    session_.clear();
    try {
      call("Target.closeTarget", {{"targetId", tab_}});
    } catch (const std::exception&) {  // the program has ended, and the test knows
    }
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a page from disk, with `state` behind its "#", and waits until `is_ready` is true there.
  void open(const std::filesystem::path& page, const std::string& state,
            const std::string& is_ready) {
    call("Page.navigate", {{"url", "about:blank"}});
    call("Page.navigate", {{"url", "file://" + page.string() + "#" + state}});
    wait_for(is_ready);
  }

  /// The value of an expression; for a promise, the value that it resolves to.
  Json js(const std::string& expression) {
    const Json result =
        call("Runtime.evaluate",
             {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
    if (result.contains("exceptionDetails"))
      throw std::runtime_error(expression + ": " + result.at("exceptionDetails").dump());
    return result.at("result").value("value", Json());
  }

  void wait_for(const std::string& expression) {
    for (int k = 0; k < 600; ++k) {
      if (js("!!(" + expression + ")") == true) return;
      usleep(50000);
    }
    throw std::runtime_error("never true: " + expression);
  }

  /// The position is in the page's pixels, from the upper left corner of the window.
  void click(double x, double y) {
    for (const char* type : {"mousePressed", "mouseReleased"})
      call("Input.dispatchMouseEvent",
           {{"type", type}, {"x", x}, {"y", y}, {"button", "left"}, {"clickCount", 1}});
  }
  void hover(double x, double y) {
    call("Input.dispatchMouseEvent", {{"type", "mouseMoved"}, {"x", x}, {"y", y}});
  }
  void key(const std::string& name, const std::string& text = {}) {
    for (const char* type : {"keyDown", "keyUp"})
      call("Input.dispatchKeyEvent", {{"type", type}, {"key", name}, {"text", text}});
  }

 private:
  static std::shared_ptr<BrowserProgram> shared() {
    static const auto program = std::make_shared<BrowserProgram>(std::vector<std::string>{});
    return program;
  }

  Json call(const std::string& method, const Json& parameters = Json::object()) {
    return program_->call(session_, method, parameters, [&](const Json& event) { note(event); });
  }

  void note(const Json& event) {
    if (event.value("sessionId", "") != session_) return;  // of another tab, or of none
    const std::string method = event.value("method", "");
    const bool is_bad =
        method == "Runtime.exceptionThrown" || method == "Network.loadingFailed" ||
        (method == "Runtime.consoleAPICalled" && event["params"]["type"] != "log") ||
        (method == "Log.entryAdded" && event["params"]["entry"]["level"] == "error");
    if (is_bad) complaints_.push_back(event.at("params").dump().substr(0, 500));
  }

  /// Errors and warnings that pages wrote to the console, exceptions, failed requests.
  std::vector<std::string> complaints_;
  const std::shared_ptr<BrowserProgram> program_;
  const bool can_draw_;
  std::string tab_, session_;
};

}  // namespace ballast
