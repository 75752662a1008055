#include "debug/breakpoint.hpp"

#include <utility>

#include "debug/mistake.hpp"
#include "debug/typed_text.hpp"
#include "lang/diagnostic.hpp"

namespace opentmcl::debug {

using client::Result;

Result<HitCondition> HitCondition::parse(std::string_view text) {
  struct Sign {
    std::string_view text;
    Kind kind;
  };
  // A sign that begins with another one stands before it.
  constexpr Sign signs[] = {{"==", Kind::equal}, {">=", Kind::from}, {"=", Kind::equal},
                            {">", Kind::after},  {"%", Kind::every}, {"", Kind::equal}};
  std::string_view rest = trimmed(text);
  HitCondition condition;
  for (const Sign& sign : signs) {
    if (!rest.starts_with(sign.text)) continue;
    condition.kind_ = sign.kind;
    rest.remove_prefix(sign.text.size());
    break;
  }
  condition.count_ = number_in<std::uint64_t>(trimmed(rest)).value_or(0);
  if (condition.count_ == 0) {
    return mistake("expected a count of hits from 1 on, such as 3, >= 3 or % 10, not " + lang::in_quotes(text));
  }
  return condition;
}

bool HitCondition::holds(std::uint64_t hits) const {
  switch (kind_) {
    case Kind::equal:
      return hits == count_;
    case Kind::from:
      return hits >= count_;
    case Kind::after:
      return hits > count_;
    case Kind::every:
      return hits % count_ == 0;
  }
  return true;
}

std::string HitCondition::text() const {
  constexpr const char* signs[] = {"== ", ">= ", "> ", "% "};
  return signs[static_cast<std::size_t>(kind_)] + std::to_string(count_);
}

Result<LogMessage> LogMessage::parse(std::string_view text, const Program& program) {
  LogMessage message;
  message.text_ = text;
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if ((c == '{' || c == '}') && i + 1 < text.size() && text[i + 1] == c) {
      plain += c;
      ++i;
    } else if (c == '{') {
      const std::size_t end = text.find('}', i);
      if (end == std::string_view::npos) return mistake("the '{' in " + lang::in_quotes(text) + " is not closed");
      Result<ValueExpression> expression = ValueExpression::parse(text.substr(i + 1, end - i - 1), program);
      if (!expression) return expression.error();
      message.pieces_.emplace_back(std::exchange(plain, {}));
      message.pieces_.emplace_back(std::move(*expression));
      i = end;
    } else {
      plain += c;
    }
  }
  message.pieces_.emplace_back(std::move(plain));
  return message;
}

std::string LogMessage::fill_in(ValueSource& source) const {
  std::string filled;
  for (const auto& piece : pieces_) {
    if (const auto* const plain = std::get_if<std::string>(&piece)) {
      filled += *plain;
      continue;
    }
    const Result<double> value = std::get<ValueExpression>(piece).evaluate(source);
    filled += value ? value_text(*value) : "<" + value.error().message + ">";
  }
  return filled;
}

Result<Breakpoint> make_breakpoint(BreakpointRequest request, const Program& program, TwinPowers* twin) {
  Breakpoint breakpoint;
  if (!request.condition.empty()) {
    Result<ValueExpression> condition = ValueExpression::parse(request.condition, program);
    if (!condition) return condition.error();
    breakpoint.condition.emplace(std::move(*condition));
  }
  if (!request.hit_condition.empty()) {
    const Result<HitCondition> hits = HitCondition::parse(request.hit_condition);
    if (!hits) return hits.error();
    breakpoint.hit_condition = *hits;
  }
  if (!request.log_message.empty()) {
    Result<LogMessage> message = LogMessage::parse(request.log_message, program);
    if (!message) return message.error();
    breakpoint.log_message.emplace(std::move(*message));
  }
  if (request.kind == BreakpointRequest::Kind::change) {
    Result<ValueExpression> watched = ValueExpression::parse(request.subject, program);
    if (!watched) return watched.error();
    breakpoint.watched.emplace(std::move(*watched));
  }
  if (request.kind == BreakpointRequest::Kind::signal) {
    if (twin == nullptr) {
      return mistake(
          "signals can only be seen in a twin (port sim:pd1161); on a module watch a parameter instead, "
          "such as GAP(3)");
    }
    Result<std::unique_ptr<Signal>> signal = twin->signal(request.subject);
    if (!signal) return signal.error();
    breakpoint.signal = std::move(*signal);
  }
  breakpoint.request = std::move(request);
  return breakpoint;
}

}  // namespace opentmcl::debug
