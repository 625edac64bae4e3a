function hbvib_install(library, headers)
%HBVIB_INSTALL  Compiles the gateway to the library and puts the classes on the path. Needs a C compiler.
%
%   hbvib_install                     the library of the checkout, which `cargo build --release` made
%   hbvib_install(PREFIX)             of `sh examples/install.sh PREFIX`
%   hbvib_install(LIBRARY, HEADERS)   a file libhbvib.so, .dylib or .dll.lib, and the folder of hbvib.h
%
%   The gateway keeps the library beside itself, so that this folder may be moved.
  here = fileparts(mfilename('fullpath'));
  names = {'libhbvib.so', 'libhbvib.dylib', 'hbvib.dll'};
  if nargin == 2
    found = library;
  else
    if nargin == 0
      places = {fullfile(here, '..', 'target', 'release'), fullfile(here, '..', '..', '..', 'lib')};
      headers = {fullfile(here, '..', 'include'), fullfile(here, '..', '..', '..', 'include')};
    else
      places = {fullfile(library, 'lib'), library};
      headers = {fullfile(library, 'include'), library};
    end
    found = '';
    for place = places
      for name = names
        file = fullfile(place{1}, name{1});
        if isempty(found) && exist(file, 'file'), found = file; end
      end
    end
    headers = headers(cellfun(@(folder) exist(fullfile(folder, 'hbvib.h'), 'file') > 0, headers));
    if isempty(found) || isempty(headers)
      error('hbvib:install', 'no library with its header in %s: run cargo build --release, or name the prefix', ...
            strjoin(places, ', '));
    end
    headers = headers{1};
  end
  [~, name, ending] = fileparts(found);
  % The name that the gateway asks for at run time.
  copy = [name, ending];
  if strcmp(ending, '.so')
    version = fileread(fullfile(headers, 'hbvib.h'));
    major = regexp(version, 'define HBVIB_VERSION_MAJOR (\d+)', 'tokens', 'once');
    minor = regexp(version, 'define HBVIB_VERSION_MINOR (\d+)', 'tokens', 'once');
    copy = sprintf('libhbvib.so.%s.%s', major{1}, minor{1});
  end
  copyfile(found, fullfile(here, copy));
  source = fullfile(here, 'hbvib_mex.c');
  if exist('OCTAVE_VERSION', 'builtin')
    [text, status] = mkoctfile('--mex', '-o', fullfile(here, 'hbvib_mex.mex'), ['-I', headers], source, ...
                               ['-L', here], ['-l:', copy], '-Wl,-rpath,\\\$ORIGIN');
    if status ~= 0, error('hbvib:install', 'the gateway was not compiled: %s', text); end
  elseif ispc
    mex('-R2017b', ['-I', headers], '-outdir', here, source, found, '-lut');
  elseif ismac
    mex('-R2017b', ['-I', headers], '-outdir', here, source, found, '-lut', 'LDFLAGS=$LDFLAGS -Wl,-rpath,@loader_path');
  else
    mex('-R2017b', ['-I', headers], '-outdir', here, source, fullfile(here, copy), '-lut', ...
        'LDFLAGS=$LDFLAGS -Wl,-rpath,\$ORIGIN');
  end
  addpath(here);
  fprintf('hbvib %s: the gateway is in %s. `addpath %s` in each session, or savepath once.\n', ...
          hbvib_mex('version_string'), here, here);
end
