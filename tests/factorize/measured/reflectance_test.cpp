#include "factorize/reflectance.hpp"

#include <gmock/gmock.h>

#include "core/error.hpp"
#include "tests/factorize/measured/measured_support.hpp"

namespace nacre {
namespace {

using namespace nacre::test;
using testing::HasSubstr;

template <class T>
std::string complaint(const std::string& source) {
    return messageOf<T>([&] { openReflectance(source); });
}

TEST(OpenReflectance, ModelsAreKnownByName) {
    EXPECT_EQ(openReflectance("lambert").kind, "analytic");
    EXPECT_THAT(complaint<std::invalid_argument>("lambertt"), HasSubstr("lambert"));
    EXPECT_THAT(complaint<std::invalid_argument>("no-such-model:color=0.1/0.2/0.3"), HasSubstr("lambert"));
}

TEST(OpenReflectance, MissingFilesAreErrorsAndNotUnknownModels) {
    for (const char* source : {"no/such/file", "absent.binary", "absent.bsdf", "absent.csv", "/nowhere/x.bsdf"})
        EXPECT_THAT(complaint<Error>(source), HasSubstr(std::string(source) + ": expected a file, found none"));
    EXPECT_THAT(complaint<Error>("/"), HasSubstr("/: expected a file, found a folder or device"));
}

TEST(OpenReflectance, FilesAreKnownBySuffixOrContent) {
    const TemporaryFolder folder;
    EXPECT_THAT(complaint<Error>(folder.write("a.binary", "short")), HasSubstr("expected a MERL table"));
    EXPECT_THAT(complaint<Error>(folder.write("a.bsdf", "short")), HasSubstr("a tensor file's signature"));
    EXPECT_THAT(complaint<Error>(folder.write("a.csv", "x,y\n")), HasSubstr("line 1: expected a header"));
    const std::string merlStart("\x5a\0\0\0\x5a\0\0\0\xb4\0\0\0", 12), tensorStart("tensor_file\0\x1\0", 14);
    EXPECT_THAT(complaint<Error>(folder.write("unnamed1", merlStart)), HasSubstr("for MERL dimensions"));
    EXPECT_THAT(complaint<Error>(folder.write("unnamed2", tensorStart)), HasSubstr("number of fields"));
    EXPECT_THAT(complaint<Error>(folder.write("unnamed3", "text")), HasSubstr("expected a reflectance file"));
}

}  // namespace
}  // namespace nacre
