// fxc's command line over Microsoft's d3dcompiler_47.dll, for machines without the Windows SDK; tools/README.md says how
// to build and run it. Takes -T PROFILE, -E ENTRY, -Fo OUTPUT, -I DIRECTORY, -D NAME[=VALUE], -Gec, -nologo and one file.

#define CINTERFACE
#define COBJMACROS
#include <d3dcompiler.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 16 };

static const char *profile, *entry, *output, *file, *directories[MOST];
static D3D_SHADER_MACRO macros[MOST + 1];
static int directory_count, macro_count;
static UINT flags = D3DCOMPILE_OPTIMIZATION_LEVEL3;

static char *read_file(const char *path, UINT *size) {
  FILE *stream = fopen(path, "rb");
  if (!stream) return NULL;
  fseek(stream, 0, SEEK_END);
  *size = ftell(stream);
  rewind(stream);
  char *text = malloc(*size + 1);
  *size = fread(text, 1, *size, stream);
  fclose(stream);
  return text;
}

static HRESULT STDMETHODCALLTYPE open_include(
    ID3DInclude *self, D3D_INCLUDE_TYPE type, LPCSTR name, LPCVOID parent, LPCVOID *text, UINT *size) {
  (void)self, (void)type, (void)parent;
  *text = read_file(name, size);
  for (int i = 0; !*text && i < directory_count; i++) {
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", directories[i], name);
    *text = read_file(path, size);
  }
  return *text ? S_OK : E_FAIL;
}

static HRESULT STDMETHODCALLTYPE close_include(ID3DInclude *self, LPCVOID text) {
  (void)self;
  free((void *)text);
  return S_OK;
}

static void add_macro(char *definition) {
  char *equals = strchr(definition, '=');
  if (equals) *equals = '\0';
  macros[macro_count++] = (D3D_SHADER_MACRO){definition, equals ? equals + 1 : "1"};
}

static int read_arguments(int count, char **arguments) {
  for (int i = 1; i < count; i++) {
    char *argument = arguments[i];
    if (!strcmp(argument, "-nologo")) continue;
    if (!strcmp(argument, "-Gec")) {
      flags |= D3DCOMPILE_ENABLE_BACKWARDS_COMPATIBILITY;
      continue;
    }
    if (argument[0] != '-') {
      file = argument;
      continue;
    }
    int letters = strncmp(argument, "-Fo", 3) ? 2 : 3;
    char *value = argument[letters] ? argument + letters : i + 1 < count ? arguments[++i] : "";
    if (letters == 3) output = value;
    else if (argument[1] == 'T') profile = value;
    else if (argument[1] == 'E') entry = value;
    else if (argument[1] == 'I' && directory_count < MOST) directories[directory_count++] = value;
    else if (argument[1] == 'D' && macro_count < MOST) add_macro(value);
    else return printf("fxc: unknown or one too many: %s\n", argument), 0;
  }
  return profile && entry && file;
}

int main(int count, char **arguments) {
  if (!read_arguments(count, arguments)) return puts("usage: fxc -T PROFILE -E ENTRY [-Fo OUTPUT] [-I...] [-D...] FILE"), 2;
  UINT size;
  char *text = read_file(file, &size);
  if (!text) return printf("fxc: cannot read %s\n", file), 2;
  ID3DIncludeVtbl methods = {open_include, close_include};
  ID3DInclude includes = {&methods};
  ID3DBlob *code = NULL, *messages = NULL;
  HRESULT result = D3DCompile(
      text, size, file, macros, &includes, entry, profile, flags, 0, &code, &messages);
  if (messages) fputs(ID3D10Blob_GetBufferPointer(messages), stderr);
  if (FAILED(result)) return 1;
  FILE *stream = output ? fopen(output, "wb") : NULL;
  if (stream) fwrite(ID3D10Blob_GetBufferPointer(code), 1, ID3D10Blob_GetBufferSize(code), stream), fclose(stream);
  return 0;
}
