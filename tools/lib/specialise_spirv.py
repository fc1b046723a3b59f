"""What a SPIR-V module holds once its specialisation constants have their values: folded by spirv-opt, counted here."""

import struct
import subprocess
import tempfile

OP_FUNCTION, OP_FUNCTION_END, OP_DECORATE = 54, 56, 71
OP_SPEC_CONSTANT_TRUE, OP_SPEC_CONSTANT_FALSE = 48, 49
OP_LINE, OP_NO_LINE, OP_LABEL = 8, 317, 248
NO_WORK = {OP_FUNCTION, OP_FUNCTION_END, OP_LINE, OP_NO_LINE, OP_LABEL}
DECORATION_SPEC_ID = 1
HEADER_WORDS = 5


def instructions(module):
    """(opcode, operands) of each, in order (SPIR-V specification, 2.3)."""
    words = struct.unpack(f"<{len(module) // 4}I", module)
    at = HEADER_WORDS
    while at < len(words):
        length, opcode = words[at] >> 16, words[at] & 0xFFFF
        yield opcode, words[at + 1:at + length]
        at += length


def boolean_constants(module):
    """The numbers of the specialisation constants that are true or false."""
    number_of = {operands[0]: operands[2] for opcode, operands in instructions(module)
                 if opcode == OP_DECORATE and operands[1] == DECORATION_SPEC_ID}
    return {number_of[operands[1]] for opcode, operands in instructions(module)
            if opcode in (OP_SPEC_CONSTANT_TRUE, OP_SPEC_CONSTANT_FALSE)}


def count_instructions(module):
    """Those in functions that do something."""
    inside, count = False, 0
    for opcode, _ in instructions(module):
        inside = opcode == OP_FUNCTION or inside and opcode != OP_FUNCTION_END
        count += inside and opcode not in NO_WORK
    return count


def constants_of(module):
    """The numbers of all specialisation constants."""
    return {operands[2] for opcode, operands in instructions(module)
            if opcode == OP_DECORATE and operands[1] == DECORATION_SPEC_ID}


def folded(path, specialization):
    """The module with these values, by number, as constants, and without what they make unreachable."""
    module = path.read_bytes()
    booleans, present = boolean_constants(module), constants_of(module)
    values = {int(number): value for number, value in specialization.items()}
    words = [f"{number}:{('true' if value else 'false') if number in booleans else value}"
             for number, value in values.items() if number in present]
    with tempfile.NamedTemporaryFile(suffix=".spv") as output:
        command = ["spirv-opt", "--set-spec-const-default-value=" + " ".join(words), "--freeze-spec-const",
                   "--fold-spec-const-op-composite", "--ccp", "-O", "--eliminate-dead-const", path, "-o", output.name]
        subprocess.run(command, check=True, capture_output=True)
        return output.read()
