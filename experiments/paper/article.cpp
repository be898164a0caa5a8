#include <ostream>

#include "experiments/paper/sections.hpp"
#include "platform/atomic_file.hpp"
#include "platform/program.hpp"

namespace ballast {

std::string article_prose();  // article.md

namespace {

namespace fs = std::filesystem;

/// The text in the notation of Pandoc.
std::string pandoc_of(const page::Text& text) {
  std::string result;
  for (const page::Span& span : text.spans) {
    const char* mark = span.styles & page::superscript ? "^"
                       : span.styles & page::subscript ? "~"
                       : span.styles & page::symbol    ? "*"
                                                       : "";
    result += mark;
    for (const char c : span.text) {
      if (std::string_view("\\`*_~^$[]<>{}").find(c) != std::string_view::npos) result += '\\';
      result += c;
    }
    result += mark;
  }
  return result;
}

/// Makes article.<suffix> in `folder` by Pandoc. Returns false if Pandoc is missing or failed.
bool typeset(const fs::path& folder, const std::string& suffix, std::vector<std::string> arguments,
             std::ostream& notes) {
  const std::string target = (folder / ("article." + suffix)).string();
  arguments.insert(arguments.end(), {"--standalone", "--resource-path=" + folder.string(),
                                     "--output=" + target, (folder / "article.md").string()});
  const ProgramResult result = run_program("pandoc", arguments, /*seconds=*/300.0);
  if (result.succeeded()) return true;
  notes << "ballast: " << target << " is not made: "
        << (result.status == 127 ? "pandoc is missing (docs/manual/paper.md has the packages)"
                                 : result.errors)
        << std::endl;
  return false;
}

}  // namespace

std::string article_of(std::string_view prose, const page::Values& numbers) {
  return page::filled(prose, [&](const std::string& name) {
    const auto number = numbers.find(name);
    if (number == numbers.end()) throw Error("article.md: the report has no number " + name);
    return pandoc_of(number->second);
  });
}

std::string article_of(const std::vector<PaperSection>& sections) {
  page::Values numbers;
  for (const PaperSection& section : sections)
    numbers.insert(section.numbers.begin(), section.numbers.end());
  return article_of(article_prose(), numbers);
}

ExitCode write_article(PaperData& data, const fs::path& folder, std::ostream& notes) {
  const std::vector<PaperSection> sections = make_sections(data, "all");
  const std::string prose = article_prose();
  page::Section shown{"figures", ""};
  for (const PaperSection& section : sections)
    for (const page::Picture& figure : section.figures)
      if (prose.find("(figures/" + figure.plot.name + ".svg)") != prose.npos) shown.add(figure);
  page::Page pictures{.sections = {shown}};
  create_folder(folder);
  write_whole_file(folder / "article.md", article_of(sections));  // first: marks the folder as ours
  page::draw_pictures(pictures, folder, {.is_file_shown = true});
  const bool html = typeset(folder, "html", {"--mathml", "--self-contained"}, notes),
             pdf = typeset(folder, "pdf", {"--pdf-engine=xelatex"}, notes);
  return html && pdf ? ExitCode::ok : ExitCode::backend_missing;
}

}  // namespace ballast
