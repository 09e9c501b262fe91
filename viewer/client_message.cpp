#include <utility>

#include "common/utf8.hpp"
#include "viewer/message_parts.hpp"

namespace irdm::viewer {
namespace {

struct ClientEncoder {
  Writer& writer;

  void operator()(const Hello& hello) const {
    const std::string token = hello.token.substr(0, kMaxTokenLength);
    put_header(writer, Type::kHello);
    writer.put(static_cast<std::uint16_t>(token.size()));
    writer.put(static_cast<std::uint16_t>(hello.looks_on ? 1 : 0));
    writer.put_text(token);
  }
  void operator()(const Command& command) const {
    put_header(writer, Type::kCommand);
    writer.put(static_cast<std::uint16_t>(command.kind));
    writer.put(command.number);
    writer.put_zeros(4);
    writer.put(command.value);
  }
  void operator()(const StylusRequest& stylus) const {
    put_header(writer, Type::kStylus);
    writer.put(static_cast<std::uint8_t>(stylus.present ? 1 : 0));
    writer.put_zeros(3);
    writer.put(stylus.buttons);
    writer.put(stylus.tip);
  }
  void operator()(const SettingsRequest& request) const {
    put_header(writer, Type::kSettings);
    writer.put(static_cast<std::uint16_t>(request.objects));
    writer.put_zeros(6);
    writer.put(request.settings.gravity);
    for (std::size_t i = 0; i < request.objects; ++i) {
      put_settings(writer, request.settings.object.at(i), {});
    }
  }
  void operator()(const SceneRequest& request) const {
    const std::string name = request.name.substr(0, kMaxSceneName);
    put_header(writer, Type::kLoadScene);
    writer.put(static_cast<std::uint16_t>(name.size()));
    writer.put_zeros(2);
    writer.put_text(name);
  }
};

Hello get_hello(Reader& reader) {
  const auto length = reader.get<std::uint16_t>();
  if (length > kMaxTokenLength) throw MessageError("its token is too long");
  const auto looks_on = reader.get<std::uint16_t>();
  if (looks_on > 1) throw MessageError("a number is out of range");
  return {reader.get_text(length), looks_on == 1};
}

Command get_command(Reader& reader) {
  const auto kind = reader.get<std::uint16_t>();
  if (kind < static_cast<std::uint16_t>(CommandKind::kReset) ||
      kind > static_cast<std::uint16_t>(CommandKind::kSaveScene)) {
    throw MessageError("the command is unknown");
  }
  Command command;
  command.kind = static_cast<CommandKind>(kind);
  command.number = reader.get<std::uint16_t>();
  reader.skip(4);
  command.value = reader.get_double();
  const auto value_between = [&](double least, double largest) {
    if (!(command.value >= least && command.value <= largest)) {
      throw MessageError("a number is out of range");
    }
  };
  if (command.kind == CommandKind::kStep && (command.number < 1 || command.number > 1000)) {
    throw MessageError("a number is out of range");
  }
  if (command.kind == CommandKind::kSeek) value_between(0.0, 1e9);
  if (command.kind == CommandKind::kSetSpeed) value_between(0.01, 10.0);
  return command;
}

StylusRequest get_stylus_request(Reader& reader) {
  StylusRequest stylus;
  const auto present = reader.get<std::uint8_t>();
  if (present > 1) throw MessageError("a number is out of range");
  stylus.present = present == 1;
  reader.skip(3);
  stylus.buttons = reader.get<std::uint32_t>();
  stylus.tip = get_bounded_vector(reader, kFarthest);
  return stylus;
}

SettingsRequest get_settings_request(Reader& reader) {
  SettingsRequest request;
  request.objects = get_count(reader, kMaxObjects);
  reader.skip(6);
  request.settings.gravity = get_bounded_vector(reader, kMostGravity);
  SettingsChoice ignored;
  for (std::size_t i = 0; i < request.objects; ++i) {
    request.settings.object.at(i) = get_settings(reader, ignored);
  }
  return request;
}

SceneRequest get_scene_request(Reader& reader) {
  const auto length = reader.get<std::uint16_t>();
  if (length < 1 || length > kMaxSceneName) throw MessageError("a name is too long or empty");
  reader.skip(2);
  std::string name = reader.get_text(length);
  if (!is_utf8(name)) throw MessageError("a name is not UTF-8");
  return {std::move(name)};
}

ClientMessage get_client_message(Reader& reader) {
  switch (get_header(reader)) {
    case Type::kHello:
      return get_hello(reader);
    case Type::kCommand:
      return get_command(reader);
    case Type::kStylus:
      return get_stylus_request(reader);
    case Type::kSettings:
      return get_settings_request(reader);
    case Type::kLoadScene:
      return get_scene_request(reader);
    default:
      throw MessageError("it is of another type");
  }
}

}  // namespace

Bytes encode(const ClientMessage& message) {
  Bytes bytes;
  Writer writer(bytes);
  std::visit(ClientEncoder{writer}, message);
  return bytes;
}

ClientMessage decode_client(std::span<const std::uint8_t> bytes) {
  Reader reader(bytes);
  ClientMessage message = get_client_message(reader);
  reader.finish();
  return message;
}

}  // namespace irdm::viewer
