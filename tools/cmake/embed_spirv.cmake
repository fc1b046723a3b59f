# Writes a SPIR-V file as a C++ array: cmake -DNAME=... -DSPIRV=... -DOUTPUT=... -P embed_spirv.cmake
file(READ ${SPIRV} bytes HEX)
# SPIR-V words are little-endian in the file: the four bytes are turned round.
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1u," words "${bytes}")
file(WRITE ${OUTPUT} "#include \"kernels/spirv.h\"\nnamespace isolux::kernels {\nnamespace {\nconstexpr std::uint32_t words[] = {${words}};\n}\nconst std::span<const std::uint32_t> ${NAME}{words};\n} // namespace isolux::kernels\n")
