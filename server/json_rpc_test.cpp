#include "server/json_rpc.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <optional>

namespace opentmcl::server {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

/// The methods that the examples of the specification use, and one that is answered later.
struct JsonRpc : testing::Test {
  std::vector<RpcAnswer> later;
  std::vector<std::string> called;

  std::vector<std::string> responses_to(const std::string& text) {
    std::vector<std::string> responses;
    take_json_rpc(
        text,
        [this](const std::string& method, const json& params, const RpcAnswer& answer) {
          call(method, params, answer);
        },
        [&responses](std::string response) { responses.push_back(std::move(response)); });
    return responses;
  }
  std::string response_to(const std::string& text) {
    const std::vector<std::string> responses = responses_to(text);
    return responses.size() == 1 ? responses.front() : std::to_string(responses.size()) + " responses";
  }
  void call(const std::string& method, const json& params, const RpcAnswer& answer) {
    called.push_back(method);
    if (method == "subtract") {
      answer(ordered_json(params.is_array() ? params[0].get<int>() - params[1].get<int>()
                                            : params["minuend"].get<int>() - params["subtrahend"].get<int>()));
    } else if (method == "later") {
      later.push_back(answer);
    } else {
      answer(RpcError{RpcError::method_not_found, "no method " + method});
    }
  }
  int error_code(const std::string& text) {
    const json response = json::parse(response_to(text));
    EXPECT_EQ("2.0", response.at("jsonrpc"));
    EXPECT_FALSE(response.contains("result"));
    return response.at("error").at("code");
  }
};

TEST_F(JsonRpc, AnswersTheExamplesOfTheSpecification) {
  EXPECT_EQ(R"({"jsonrpc":"2.0","id":1,"result":19})",
            response_to(R"({"jsonrpc": "2.0", "method": "subtract", "params": [42, 23], "id": 1})"));
  EXPECT_EQ(
      R"({"jsonrpc":"2.0","id":4,"result":19})",
      response_to(R"({"jsonrpc": "2.0", "method": "subtract", "params": {"minuend": 42, "subtrahend": 23}, "id": 4})"));
  EXPECT_EQ(R"({"jsonrpc":"2.0","id":"1","error":{"code":-32601,"message":"no method foobar"}})",
            response_to(R"({"jsonrpc": "2.0", "method": "foobar", "id": "1"})"));
  EXPECT_EQ(-32700, error_code(R"({"jsonrpc": "2.0", "method": "foobar, "params": "bar", "baz])"));
  EXPECT_EQ(-32600, error_code(R"({"jsonrpc": "2.0", "method": 1, "params": "bar"})"));
  EXPECT_EQ(-32700, error_code(R"([{"jsonrpc": "2.0", "method": "sum", "id": "1"}, {"jsonrpc": "2.0", "method")"));
  EXPECT_EQ(-32600, error_code("[]"));
  EXPECT_EQ(3u, json::parse(response_to("[1,2,3]")).size());
}

TEST_F(JsonRpc, DoesNotAnswerNotifications) {
  EXPECT_TRUE(responses_to(R"({"jsonrpc": "2.0", "method": "subtract", "params": [42, 23]})").empty());
  EXPECT_TRUE(responses_to(R"([{"jsonrpc": "2.0", "method": "foobar"}])").empty());
  EXPECT_EQ((std::vector<std::string>{"subtract", "foobar"}), called);
}

TEST_F(JsonRpc, AnswersABatchWhenAllOfItIsAnswered) {
  const char* batch = R"([{"jsonrpc":"2.0","method":"later","id":1},
                          {"jsonrpc":"2.0","method":"subtract","params":[3,1],"id":2},
                          {"jsonrpc":"2.0","method":"later","id":3}])";
  std::vector<std::string> responses;
  take_json_rpc(
      batch,
      [this](const std::string& method, const json& params, const RpcAnswer& answer) { call(method, params, answer); },
      [&responses](std::string response) { responses.push_back(std::move(response)); });
  later[1](ordered_json("third"));
  later[1] = nullptr;
  EXPECT_TRUE(responses.empty());
  later[0](ordered_json("first"));
  later[0] = nullptr;
  ASSERT_EQ(1u, responses.size());
  EXPECT_EQ(R"([{"jsonrpc":"2.0","id":2,"result":2},{"jsonrpc":"2.0","id":3,"result":"third"},)"
            R"({"jsonrpc":"2.0","id":1,"result":"first"}])",
            responses.front());
}

TEST_F(JsonRpc, RefusesWhatIsNoRequest) {
  for (const char* text :
       {"1", "null", "\"text\"", "{}", R"({"method":"x","id":1})", R"({"jsonrpc":"1.0","method":"x","id":1})",
        R"({"jsonrpc":"2.0","id":1})", R"({"jsonrpc":"2.0","method":"x","id":[]})",
        R"({"jsonrpc":"2.0","method":"x","params":1,"id":1})"}) {
    EXPECT_EQ(-32600, error_code(text)) << text;
  }
  EXPECT_TRUE(called.empty());
  std::string flood = "[1";
  for (int i = 0; i < 1000; ++i) flood += ",1";
  EXPECT_EQ(-32600, error_code(flood + "]"));
}

TEST_F(JsonRpc, SurvivesTextsThatAreDeep) {
  constexpr std::size_t depth = 100'000;
  EXPECT_EQ(-32700, error_code(std::string(depth, '[')));
  EXPECT_EQ(-32600, json::parse(response_to(std::string(depth, '[') + std::string(depth, ']')))[0]["error"]["code"]);
}

RC_GTEST_PROP(JsonRpcText, IsAlwaysAnsweredByOneTextOrNone, (const std::string& text)) {
  const std::string around = *rc::gen::element<std::string>("", "{", "[", R"({"jsonrpc":"2.0",)");
  int count = 0;
  take_json_rpc(
      around + text, [](const std::string&, const json&, const RpcAnswer& answer) { answer(ordered_json(1)); },
      [&count](const std::string& response) {
        ++count;
        RC_ASSERT(json::accept(response));
      });
  RC_ASSERT(count <= 1);
}

}  // namespace
}  // namespace opentmcl::server
