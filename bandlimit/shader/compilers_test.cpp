#include "bandlimit/shader/compilers_test.h"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace bandlimit::test {
namespace {

namespace fs = std::filesystem;

/// The Slang compiler inside the Python package that scripts/setup installs; empty if there is none.
std::string slang_library() {
    const fs::path tools = fs::path(BANDLIMIT_SHADER_TOOLS) / "lib";
    std::error_code none;
    for (const auto& python : fs::directory_iterator(tools, none))
        for (const auto& file : fs::directory_iterator(python.path() / "site-packages" / "slangpy", none))
            if (file.path().filename().string().starts_with("libslang-compiler.so")) return file.path().string();
    return "";
}

/// Slang's C interface, of which these few functions are enough. Its numbers are from slang.h.
class Slang {
public:
    static const Slang& instance() {
        static const Slang slang;
        return slang;
    }

    std::string spirv(Dialect dialect, const std::string& source, const std::string& entry) const {
        constexpr int target_spirv = 6, stage_compute = 6, language_slang = 1, language_hlsl = 2;
        void* request = function<void*(void*)>("spCreateCompileRequest")(session_);
        function<void(void*, int)>("spSetCodeGenTarget")(request, target_spirv);
        // Registers s0 and u0 as bindings 1 and 2.
        const char* shifts[] = {"-fvk-t-shift", "0", "0", "-fvk-s-shift", "1", "0", "-fvk-u-shift", "2", "0"};
        function<int(void*, const char* const*, int)>("spProcessCommandLineArguments")(request, shifts, 9);
        const int language = dialect == Dialect::hlsl ? language_hlsl : language_slang;
        const int unit = function<int(void*, int, const char*)>("spAddTranslationUnit")(request, language, "shader");
        function<void(void*, int, const char*, const char*)>("spAddTranslationUnitSourceString")(
            request, unit, "shader", source.c_str());
        const int point =
            function<int(void*, int, const char*, int)>("spAddEntryPoint")(request, unit, entry.c_str(), stage_compute);
        const int result = function<int(void*)>("spCompile")(request);
        const std::string said = function<const char*(void*)>("spGetDiagnosticOutput")(request);
        std::string code;
        if (result >= 0) {
            std::size_t size = 0;
            const void* data =
                function<const void*(void*, int, std::size_t*)>("spGetEntryPointCode")(request, point, &size);
            code.assign(static_cast<const char*>(data), size);
        }
        function<void(void*)>("spDestroyCompileRequest")(request);
        if (result < 0) throw std::runtime_error("slang: " + said);
        return code;
    }

private:
    Slang() : library_(dlopen(slang_library().c_str(), RTLD_NOW | RTLD_LOCAL)) {
        if (!library_) throw std::runtime_error(dlerror());
        session_ = function<void*(const char*)>("spCreateSession")(nullptr);
    }

    template <class Signature>
    Signature* function(const char* name) const {
        return reinterpret_cast<Signature*>(dlsym(library_, name));
    }

    void* library_;
    void* session_ = nullptr;
};

std::string command_for(Compiler compiler, Dialect dialect, const std::string& in, const std::string& out,
                        const std::string& entry) {
    if (compiler == Compiler::naga) return "naga " + in + " " + out;
    const std::string glslang = "glslangValidator --quiet -V --target-env vulkan1.1 -S comp -o " + out + " ";
    if (dialect == Dialect::glsl) return glslang + in;
    // Registers s0 and u0 as bindings 1 and 2.
    return glslang + "-D -e " + entry + " --shift-sampler-binding 1 --shift-image-binding 2 " + in;
}

}  // namespace

Folder::Folder() {
    std::string name = (fs::temp_directory_path() / "bandlimit-shaders-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

std::string read_text(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string run_command(const std::string& command) {
    const Folder folder;
    const std::string said = (folder / "said").string();
    const int status = std::system(("(" + command + ") >" + said + " 2>&1 </dev/null").c_str());
    const std::string text = read_text(said);
    if (status != 0) throw std::runtime_error(command + ": " + text);
    return text;
}

bool on_path(const std::string& program) {
    std::istringstream path(std::getenv("PATH") ? std::getenv("PATH") : "");
    for (std::string folder; std::getline(path, folder, ':');)
        if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
    return false;
}

std::string missing(Compiler compiler) {
    switch (compiler) {
        case Compiler::glslang: return on_path("glslangValidator") ? "" : "no glslangValidator: install glslang-tools";
        case Compiler::naga: return on_path("naga") ? "" : "no naga on PATH";
        case Compiler::slang:
            return slang_library().empty() ? "no Slang compiler in " BANDLIMIT_SHADER_TOOLS ": run scripts/setup" : "";
    }
    return "";
}

std::vector<std::uint32_t> compile(Compiler compiler, Dialect dialect, const std::string& source,
                                   const std::string& entry) {
    std::string binary;
    if (compiler == Compiler::slang) {
        binary = Slang::instance().spirv(dialect, source, entry);
    } else {
        const Folder folder;
        const std::string in = (folder / ("shader." + std::string(name_of(dialect)))).string();
        const std::string out = (folder / "shader.spv").string();
        write_text(in, source);
        try {
            run_command(command_for(compiler, dialect, in, out, entry));
        } catch (const std::runtime_error& e) {
            throw std::runtime_error(std::string(e.what()) + "\n" + source);
        }
        binary = read_text(out);
    }
    std::vector<std::uint32_t> words(binary.size() / 4);
    std::copy(binary.begin(), binary.begin() + static_cast<std::ptrdiff_t>(words.size() * 4),
              reinterpret_cast<char*>(words.data()));
    return words;
}

}  // namespace bandlimit::test
