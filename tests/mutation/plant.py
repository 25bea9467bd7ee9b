#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Plants random one-line faults in the product: plant.py --seed N --count N --build BUILD [SOURCE_TREE].

The tree is changed in place: take a worktree. A file of engine, haptics or render is drawn by its number of lines, a function in it, a
statement in that, and a change of the statement: another comparison, sum, product or connective, a condition or a returned truth value
negated, a number changed, a call or an assignment left out. Each fault compiles with BUILD's flags and is active only where the environment
variable CATENA_FAULT holds its number (fault.h); run.py tells which of them the tests catch. A list goes to faults.json in the tree.
"""
import argparse
import glob
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

import clang.cindex as clang
from clang.cindex import CursorKind as Kind

SWAPS = {'<': '<=', '<=': '<', '>': '>=', '>=': '>', '==': '!=', '!=': '==', '+': '-', '-': '+', '*': '/', '/': '*', '&&': '||', '||': '&&'}
FUNCTIONS = (Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR, Kind.FUNCTION_TEMPLATE, Kind.CONVERSION_FUNCTION)
NUMBERS = (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL)


def commands(tree, build):
    """The compiler's command of each source file; files built in batches have the command of their batch."""
    found = {}
    for entry in json.load(open(os.path.join(build, 'compile_commands.json'))):
        name = os.path.join(entry['directory'], entry['file'])
        sources = re.findall(r'#include "([^"]+)"', open(name).read()) if '/Unity/' in name else [name]
        for source in sources:
            source = os.path.realpath(os.path.join(os.path.dirname(name), source))
            found[os.path.relpath(source, tree)] = (entry['directory'], entry['command'].split(' -o ')[0])
    return found


def command_of(file, all_commands):
    """The command of a file, or of its nearest neighbour for a header."""
    folder = os.path.dirname(file)
    while folder:
        near = sorted(name for name in all_commands if name.startswith(folder + '/'))
        if near:
            return all_commands.get(file) or all_commands[near[0]]
        folder = os.path.dirname(folder)
    return None


def bodies(cursor, path):
    """Bodies of the functions that the file defines."""
    for child in cursor.get_children():
        if child.location.file is None or child.location.file.name != path:
            if child.kind != Kind.NAMESPACE:
                continue
        if child.kind in FUNCTIONS and child.is_definition():
            yield from ((child.spelling, part) for part in child.get_children() if part.kind == Kind.COMPOUND_STMT)
        elif child.kind in (Kind.NAMESPACE, Kind.CLASS_DECL, Kind.STRUCT_DECL, Kind.CLASS_TEMPLATE):
            yield from bodies(child, path)


def statements(compound):
    """Statements below a body, each with whether it stands in a list of statements."""
    for child in compound.get_children():
        yield child
        for below in child.walk_preorder():
            if below.kind == Kind.COMPOUND_STMT:
                for inner in below.get_children():
                    yield inner


def span(cursor):
    return cursor.extent.start.offset, cursor.extent.end.offset


def changes(statement, text, number):
    """(start, end, new text, kind) of every change of a statement, without statements nested in it."""
    active = f'catena_fault({number})'
    found = []

    def visit(cursor):
        if cursor.kind in (Kind.COMPOUND_STMT, Kind.LAMBDA_EXPR):
            return
        start, end = span(cursor)
        whole = text[start:end]
        parts = list(cursor.get_children())
        if cursor.kind == Kind.BINARY_OPERATOR and len(parts) == 2 and '\n' not in whole:
            left, right = span(parts[0])[1], span(parts[1])[0]
            operator = text[left:right].strip()
            if operator in SWAPS:
                other = text[start:left] + f' {SWAPS[operator]} ' + text[right:end]
                found.append((start, end, f'({active} ? ({other}) : ({whole}))', f'{operator} -> {SWAPS[operator]}'))
        if cursor.kind in NUMBERS and re.fullmatch(r"[0-9.e+\-']+f?", whole):
            other = f'{whole} + 1' if cursor.kind == Kind.INTEGER_LITERAL else f'{whole} * 1.5' + ('f' if whole.endswith('f') else '')
            found.append((start, end, f'({active} ? {other} : {whole})', 'number'))
        if cursor.kind in (Kind.IF_STMT, Kind.WHILE_STMT) and parts and parts[0].kind not in (Kind.DECL_STMT, Kind.VAR_DECL):
            a, b = span(parts[0])
            found.append((a, b, f'({active} != static_cast<bool>({text[a:b]}))', 'condition negated'))
        if cursor.kind == Kind.RETURN_STMT and parts and parts[0].type.kind == clang.TypeKind.BOOL:
            a, b = span(parts[0])
            found.append((a, b, f'({active} != ({text[a:b]}))', 'returned value negated'))
        for part in parts:
            visit(part)

    visit(statement)
    start, end = span(statement)
    is_expression = statement.kind in (Kind.CALL_EXPR, Kind.COMPOUND_ASSIGNMENT_OPERATOR, Kind.BINARY_OPERATOR, Kind.UNARY_OPERATOR)
    if is_expression and text[end:end + 1] == ';':
        found.append((start, end + 1, f'{{ if (!{active}) {{ {text[start:end]}; }} }}', 'statement left out'))
    return found


def let_processes_report(tree):
    """Adds the listener to the test programs, and passes the variables of faults and of gcov to confined processes."""
    shutil.copy(os.path.join(tree, 'tests/mutation/listener.cpp'), os.path.join(tree, 'tests/support/mutation_listener.cpp'))
    path = os.path.join(tree, 'engine/base/helper_process.cpp')
    text = open(path).read()
    fixed, start = 'char* const environment[] = {one_thread, nullptr};', 'arguments, environment);'
    if fixed not in text or start not in text:
        raise SystemExit(f'{path}: the environment of a confined process is set in another way')
    passed = ('std::vector<char*> environment{one_thread};\n'
              '  for (char** entry = environ; *entry != nullptr; ++entry)\n'
              '    if (std::string_view(*entry).starts_with("CATENA_FAULT") || std::string_view(*entry).starts_with("GCOV"))\n'
              '      environment.push_back(*entry);\n'
              '  environment.push_back(nullptr);')
    open(path, 'w').write(text.replace(fixed, passed).replace(start, 'arguments, environment.data());'))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('tree', nargs='?', default='.')
    parser.add_argument('--seed', type=int, required=True)
    parser.add_argument('--count', type=int, default=80)
    parser.add_argument('--build', required=True, help='build folder of the same sources, for flags and precompiled headers')
    given = parser.parse_args()
    chance = random.Random(given.seed)
    let_processes_report(given.tree)
    built = os.path.realpath(os.path.join(given.build, '../..'))
    all_commands = {name: entry for name, entry in commands(built, given.build).items() if not name.startswith(('tests/', 'build/'))}
    listed = subprocess.check_output(['git', 'ls-files', 'engine', 'haptics', 'render'], cwd=given.tree, text=True).split()
    files = [f for f in listed if f.endswith(('.h', '.cpp')) and not f.startswith('engine/python/') and command_of(f, all_commands)]
    weights = [len(open(os.path.join(given.tree, f)).readlines()) for f in files]
    precompiled = tempfile.NamedTemporaryFile('w', suffix='.h')
    precompiled.write(open(os.path.join(given.build, 'CMakeFiles/catena_precompiled.dir/cmake_pch.hxx')).read())
    precompiled.flush()
    faults, index = [], clang.Index.create()
    include = '#include "tests/mutation/fault.h"\n'
    while len(faults) < given.count:
        file = chance.choices(files, weights)[0]
        path = os.path.realpath(os.path.join(given.tree, file))
        text = open(path).read()
        if any(fault['file'] == file for fault in faults) or not text.isascii():
            continue  # one fault a file: offsets stay those of the compiler, which counts bytes
        folder, command = command_of(file, all_commands)
        flags = [word for word in command.split()[1:] if word.startswith(('-I', '-D', '-std', '-isystem', '/usr/include'))]
        unit = index.parse(path, flags + ['-xc++', '-include', precompiled.name])
        functions = list(bodies(unit.cursor, path))
        if not functions:
            continue
        name, body = chance.choice(functions)
        choices = [s for s in statements(body) if changes(s, text, 0)]
        if not choices:
            continue
        statement = chance.choice(choices)
        start, end, new, kind = chance.choice(changes(statement, text, len(faults)))
        changed = text[:start] + new + text[end:]
        head = changed.index('\n') + 1
        changed = changed[:head] + include + changed[head:]
        with tempfile.NamedTemporaryFile('w', suffix='.cpp') as trial:
            trial.write(changed)
            trial.flush()
            check = f'{command} -I{os.path.realpath(given.tree)} -Wno-error -w -O0 -fsyntax-only -c {trial.name}'
            if subprocess.run(check, shell=True, cwd=folder, capture_output=True).returncode != 0:
                continue
        open(path, 'w').write(changed)
        line = text.count('\n', 0, start) + 1
        faults.append({'number': len(faults), 'file': file, 'line': line, 'function': name, 'kind': kind, 'was': text[start:end], 'is': new})
        print(f'{len(faults) - 1}: {file}:{line} {name}: {kind}', flush=True)
    json.dump(faults, open(os.path.join(given.tree, 'faults.json'), 'w'), indent=1)


if __name__ == '__main__':
    sys.exit(main())
