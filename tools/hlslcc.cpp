// The command line of HLSLcc, by which Unity translates what FXC compiles: DXBC in, GLSL for Vulkan out. tools/README.md
// says how to build it. Takes the file of bytecode and that of the translation.

#include <hlslcc.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace {

const unsigned FLAGS = HLSLCC_FLAG_UNIFORM_BUFFER_OBJECT | HLSLCC_FLAG_VULKAN_BINDINGS | HLSLCC_FLAG_TRANSLATE_MATRICES |
                       HLSLCC_FLAG_INOUT_APPEND_SEMANTIC_NAMES | HLSLCC_FLAG_AVOID_SHADER_ATOMIC_COUNTERS;

class Messages : public HLSLccReflection {
  void OnDiagnostics(const std::string &message, int line, bool isError) override {
    std::fprintf(stderr, "%d: %s: %s\n", line, isError ? "error" : "warning", message.c_str());
  }
};

}  // namespace

int main(int count, char **arguments) {
  if (count != 3) return std::fputs("usage: hlslcc BYTECODE OUTPUT\n", stderr), 2;
  std::ifstream input(arguments[1], std::ios::binary);
  const std::string code((std::istreambuf_iterator<char>(input)), {});
  if (code.empty()) return std::fprintf(stderr, "hlslcc: cannot read %s\n", arguments[1]), 2;
  GlExtensions extensions = {};
  extensions.ARB_explicit_attrib_location = extensions.ARB_shading_language_420pack = extensions.OVR_multiview = 1;
  GLSLCrossDependencyData dependencies;
  HLSLccSamplerPrecisionInfo precisions;
  Messages messages;
  GLSLShader translated;
  if (!TranslateHLSLFromMem(
          code.data(), FLAGS, LANG_440, &extensions, &dependencies, precisions, messages, &translated))
    return std::fprintf(stderr, "hlslcc: does not translate %s\n", arguments[1]), 1;
  std::ofstream(arguments[2]) << translated.sourceCode;
  return 0;
}
