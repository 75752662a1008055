#include "firmware/wire/ascii_command.hpp"

#include "firmware/spec/instructions.hpp"

namespace opentmcl {

namespace {

// ---- What can be typed, copied out of the instruction table so that its descriptions stay out of the flash

template <std::size_t capacity>
struct ShortWord {
  char text[capacity];
};

template <std::size_t capacity>
consteval ShortWord<capacity> short_word(const char* word) {
  ShortWord<capacity> result{};
  for (std::size_t i = 0; word[i] != '\0'; ++i) result.text[i] = word[i];  // a longer one does not compile
  return result;
}

struct TypedOperand {
  OperandKind kind = OperandKind::none;
  Field field = Field::none;
};

struct TypedCommand {
  ShortWord<4> word{};
  Opcode opcode = {};
  std::uint8_t type = 0;
  TypedOperand operands[maximum_operands];
};

struct TypedWord {
  ShortWord<6> word{};
  OperandKind kind = OperandKind::none;
  std::uint8_t value = 0;
};

consteval std::size_t count_typed_instructions() {
  std::size_t count = 0;
  for (const InstructionSpec& row : instructions) count += row.ascii ? 1 : 0;
  return count;
}

constexpr std::size_t typed_instruction_count = count_typed_instructions();
constexpr std::size_t ascii_only_count = sizeof ascii_only_commands / sizeof ascii_only_commands[0];

struct TypedCommands {
  TypedCommand rows[typed_instruction_count + ascii_only_count];
};

consteval TypedCommands make_typed_commands() {
  TypedCommands commands;
  TypedCommand* next = commands.rows;
  for (const InstructionSpec& row : instructions) {
    if (!row.ascii) continue;
    next->word = short_word<4>(row.mnemonic);
    next->opcode = row.opcode;
    for (std::size_t i = 0; i < maximum_operands; ++i)
      next->operands[i] = {row.operands[i].kind, row.operands[i].field};
    ++next;
  }
  for (const AsciiOnlyCommand& row : ascii_only_commands) {
    next->word = short_word<4>(row.word);
    next->opcode = row.opcode;
    next->type = row.type;
    ++next;
  }
  return commands;
}

constexpr TypedCommands typed_commands = make_typed_commands();

/// The kinds of operands of those instructions that are written as words.
constexpr OperandKind typed_kinds[] = {OperandKind::mvp_mode, OperandKind::rfs_action};

consteval bool all_words_are_typed() {
  for (const TypedCommand& command : typed_commands.rows) {
    for (const TypedOperand& operand : command.operands) {
      bool found = keywords_of(operand.kind).count == 0;
      for (const OperandKind kind : typed_kinds) found = found || operand.kind == kind;
      if (!found) return false;
    }
  }
  return true;
}
static_assert(all_words_are_typed());

consteval std::size_t count_typed_words() {
  std::size_t count = 0;
  for (const OperandKind kind : typed_kinds) count += keywords_of(kind).count;
  return count;
}

struct TypedWords {
  TypedWord rows[count_typed_words()];
};

consteval TypedWords make_typed_words() {
  TypedWords words;
  TypedWord* next = words.rows;
  for (const OperandKind kind : typed_kinds) {
    const KeywordSet set = keywords_of(kind);
    for (std::size_t i = 0; i < set.count; ++i, ++next) {
      next->word = short_word<6>(set.words[i].word);
      next->kind = kind;
      next->value = set.words[i].value;
    }
  }
  return words;
}

constexpr TypedWords typed_words = make_typed_words();

// ---- Reading

constexpr bool is_space(char character) {
  return character == ' ' || character == '\t';
}
constexpr bool is_digit(char character) {
  return character >= '0' && character <= '9';
}
constexpr char upper(char character) {
  return character >= 'a' && character <= 'z' ? static_cast<char>(character - 'a' + 'A') : character;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

// In place of substr(), which would pull in an exception.
std::string_view first(std::string_view text, std::size_t length) {
  return {text.data(), length};
}
std::string_view behind(std::string_view text, std::size_t length) {
  text.remove_prefix(length);
  return text;
}

template <std::size_t capacity>
bool matches(std::string_view text, const ShortWord<capacity>& word) {
  if (text.size() > capacity) return false;
  for (std::size_t i = 0; i < capacity; ++i) {
    const char character = i < text.size() ? upper(text[i]) : '\0';
    if (character != word.text[i]) return false;
  }
  return true;
}

const TypedCommand* find_command(std::string_view text) {
  for (const TypedCommand& command : typed_commands.rows) {
    if (matches(text, command.word)) return &command;
  }
  return nullptr;
}

/// A decimal number with an optional sign. @return whether it is one, and fits
bool parse_number(std::string_view text, std::int32_t& number) {
  const bool negative = !text.empty() && text.front() == '-';
  if (!text.empty() && (negative || text.front() == '+')) text.remove_prefix(1);
  if (text.empty()) return false;
  const std::uint32_t limit = negative ? 0x8000'0000U : 0x7FFF'FFFFU;
  std::uint32_t magnitude = 0;
  for (const char character : text) {
    if (!is_digit(character)) return false;
    const auto digit = static_cast<std::uint32_t>(character - '0');
    if (magnitude > (limit - digit) / 10) return false;
    magnitude = magnitude * 10 + digit;
  }
  number = static_cast<std::int32_t>(negative ? 0U - magnitude : magnitude);
  return true;
}

bool parse_operand(std::string_view text, OperandKind kind, std::int32_t& number) {
  for (const TypedWord& word : typed_words.rows) {
    if (word.kind != kind || !matches(text, word.word)) continue;
    number = word.value;
    return true;
  }
  return parse_number(text, number);
}

/// @return what the module answers when it cannot do anything with the content of a field
constexpr Status refusal_of(Field field) {
  return field == Field::type ? Status::wrong_type : Status::invalid_value;
}

Status put(Field field, std::int32_t number, Command& command) {
  const bool is_byte = number >= 0 && number <= 255;
  switch (field) {
    case Field::type:
      command.type = static_cast<std::uint8_t>(number);
      return is_byte ? Status::ok : refusal_of(field);
    case Field::motor:
      command.motor = static_cast<std::uint8_t>(number);
      return is_byte ? Status::ok : refusal_of(field);
    case Field::value:
    case Field::none:
      command.value = number;
      break;
  }
  return Status::ok;
}

/// Takes the operands off a line one after the other.
class Operands {
 public:
  explicit Operands(std::string_view text) : rest_(trimmed(text)), has_next_(!rest_.empty()) {}

  bool has_next() const { return has_next_; }
  std::string_view next() {
    std::size_t length = 0;
    while (length < rest_.size() && rest_[length] != ',') ++length;
    const std::string_view operand = trimmed(first(rest_, length));
    has_next_ = length < rest_.size();
    rest_.remove_prefix(has_next_ ? length + 1 : length);
    return operand;
  }

 private:
  std::string_view rest_;
  bool has_next_;
};

char* put_decimal(char* text, std::int32_t number) {
  auto magnitude = static_cast<std::uint32_t>(number);
  if (number < 0) {
    *text++ = '-';
    magnitude = 0U - magnitude;
  }
  char digits[10];
  std::size_t count = 0;
  do {
    digits[count++] = static_cast<char>('0' + magnitude % 10);
    magnitude /= 10;
  } while (magnitude != 0);
  while (count > 0) *text++ = digits[--count];
  return text;
}

}  // namespace

Status parse_ascii_command(std::string_view line, Command& command) {
  const std::string_view text = trimmed(line);
  std::size_t length = 0;
  while (length < text.size() && !is_space(text[length])) ++length;
  const TypedCommand* const found = find_command(first(text, length));
  if (found == nullptr) return Status::invalid_command;
  command = {static_cast<std::uint8_t>(found->opcode), found->type, 0, 0};

  Operands operands(behind(text, length));
  Status status = Status::ok;
  std::size_t count = 0;
  bool has_value = false;
  for (const TypedOperand& operand : found->operands) {
    if (operand.kind == OperandKind::none) break;
    if (!operands.has_next()) return Status::invalid_command;
    ++count;
    has_value = has_value || operand.field == Field::value;
    std::int32_t number = 0;
    const bool is_known = parse_operand(operands.next(), operand.kind, number);
    const Status taken = is_known ? put(operand.field, number, command) : refusal_of(operand.field);
    if (status == Status::ok) status = taken;
  }
  // The manual lists STAP with a value that it ignores (erratum E-16), and samples write GAP with a third operand.
  constexpr std::size_t with_surplus = 2;
  if (count == with_surplus && !has_value && operands.has_next()) {
    std::int32_t ignored = 0;
    if (!parse_number(operands.next(), ignored)) return Status::invalid_command;
  }
  return operands.has_next() ? Status::invalid_command : status;
}

std::size_t format_ascii_reply(const Reply& reply, char* text) {
  char* end = text;
  *end++ = ascii_address(reply.host_address);
  *end++ = ascii_address(reply.module_address);
  *end++ = ' ';
  end = put_decimal(end, static_cast<std::int32_t>(reply.status));
  *end++ = ' ';
  end = put_decimal(end, reply.value);
  *end++ = carriage_return;
  return static_cast<std::size_t>(end - text);
}

}  // namespace opentmcl
