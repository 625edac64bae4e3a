classdef Branch < handle
%BRANCH  Solutions along a curve, from a forced response or a nonlinear mode; made by the solves.
%
%   Fields over the points of the curve are columns: omega, amplitude, error_estimate, harmonics_used; of a mode also
%   damping_ratio, log10_amplitude, energy; branch.field(NAME) has all. Points count from 1: those of the curve first,
%   then peaks, folds and requested solutions, whose numbers peaks, folds and at give.
%   status is 0, or positive where the solve stopped early: message says why.
  properties (SetAccess = private)
    id = uint64(0);
    status = 0;
    message = '';
    parent = [];     % of a child, which its parent frees
  end
  properties (Dependent)
    omega
    amplitude
    error_estimate
    harmonics_used
    damping_ratio
    log10_amplitude
    modal_amplitude
    energy_field
    reduction        % size of the problem that was solved
    mode_info        % of a nonlinear mode
    children         % cell array: branches that branch off, and detached curves beside it, as far as the option branches sought them
    descent          % where a child comes from: kind, bifurcation, periods, merges_at, mode, born_at_force, merges_at_force ...
    searched         % numbers of the searches beside it; the list of children is never complete
  end

  methods
    function self = Branch(id, status, parent)
      self.id = id;
      self.status = status;
      if nargin > 2
        self.parent = parent;
        self.message = hbvib_mex('status_name', status);
        return
      end
      if status ~= 0, self.message = hbvib_mex('last_error'); end
      if status > 1, warning('hbvib:stopped_early', '%s', self.message); end
    end

    function delete(self)
    % At the end of a session the gateway may be gone before its objects.
      try
        self.free();
      catch
      end
    end

    function free(self)
    %FREE  Frees the branch with its children; a child only lets go of its parent.
      if self.id ~= 0
        if isempty(self.parent), hbvib_mex('branch_free', self.id); end
        self.id = uint64(0);
        self.parent = [];
      end
    end

    function disp(self)
      if self.id == 0
        fprintf('  hbvib.Branch, freed\n');
      else
        omega = self.omega;
        fprintf('  hbvib.Branch: %d points, omega %g to %g, %s\n', numel(omega), omega(1), omega(end), ...
                hbvib_mex('status_name', self.status));
      end
    end

    function x = field(self, name)
    %FIELD  A field over the points of the curve by its name in hbvib.h, such as 'slip_fraction'.
      x = hbvib_mex('branch_field', self.id, name);
      x = reshape(x, size(x, 1), []);
    end

    function x = get.omega(self), x = self.field('omega'); end
    function x = get.amplitude(self), x = self.field('amplitude'); end
    function x = get.error_estimate(self), x = self.field('error_estimate'); end
    function x = get.harmonics_used(self), x = self.field('harmonics_used'); end
    function x = get.damping_ratio(self), x = self.field('damping_ratio'); end
    function x = get.log10_amplitude(self), x = self.field('log10_amplitude'); end
    function x = get.modal_amplitude(self), x = self.field('modal_amplitude'); end
    function x = get.energy_field(self), x = self.field('energy'); end
    function info = get.reduction(self), info = hbvib_mex('branch_reduction', self.id); end
    function info = get.mode_info(self), info = hbvib_mex('branch_mode_info', self.id); end
    function info = get.searched(self), info = hbvib_mex('branch_searched', self.id); end

    function found = get.children(self)
    % Each keeps its parent. Those of the double period have half the frequencies: their model is that of longer_period(2).
      found = cell(1, hbvib_mex('branch_children', self.id));
      for k = 1:numel(found)
        child = hbvib_mex('branch_child', self.id, k - 1);
        found{k} = hbvib.Branch(child, hbvib_mex('branch_status', child), self);
      end
    end

    function info = get.descent(self)
    % Bifurcation and mode count from 1, -1 is none; kind is that of bifurcations, -1 for a detached curve.
      info = hbvib_mex('branch_descent', self.id);
      for name = {'bifurcation', 'mode'}
        if info.(name{1}) >= 0, info.(name{1}) = info.(name{1}) + 1; end
      end
    end

    function point = from_one(self, point)
      point = hbvib.internal.zero('point', point, hbvib_mex('branch_stored', self.id));
    end

    function found = peaks(self)
    %PEAKS  Refined peaks: omega, amplitude, point.
      [found.omega, found.amplitude, point] = hbvib.internal.listed('branch_peaks', {self.id}, false, 3);
      found.point = point + 1;
    end

    function found = folds(self)
    %FOLDS  Refined folds: omega, amplitude, point.
      [found.omega, found.amplitude, point] = hbvib.internal.listed('branch_folds', {self.id}, false, 3);
      found.point = point + 1;
    end

    function found = bifurcations(self)
    %BIFURCATIONS  Points where a multiplier passes the unit circle, or a mode branches: omega, amplitude, kind, point,
    %   unstable_before, unstable_after (-1 where unknown). kind: 0 fold, 1 period doubling, 2 Neimark-Sacker, 3 branch point.
      [found.omega, found.amplitude, found.kind, point, found.unstable_before, found.unstable_after] = ...
          hbvib.internal.listed('branch_bifurcations', {self.id}, false, 6);
      found.point = point + 1;
    end

    function found = at(self, wanted)
    %AT  Every solution at entry number `wanted` of the option at: amplitude, point.
      [found.amplitude, point] = hbvib.internal.listed('branch_at', {self.id, wanted - 1}, false, 2);
      found.point = point + 1;
    end

    function x = harmonics(self, point)
    %HARMONICS  Harmonics 0 .. H at a point, ndof x (H + 1) complex: x(dof, 1 + h).
      r = self.reduction;
      n = r.degrees_of_freedom * (r.harmonics_asked + 1);
      x = hbvib_mex('branch_harmonics_with_hooks', self.id, self.from_one(point), 0, r.degrees_of_freedom, n, n, []);
      x = reshape(x, r.degrees_of_freedom, []);
    end

    function x = time_history(self, point, dof, n)
    %TIME_HISTORY  Motion of a degree of freedom at n equidistant times of a period.
      if nargin < 4, n = 256; end
      dof = hbvib.internal.zero('dof', dof, self.reduction.degrees_of_freedom);
      x = hbvib_mex('branch_time_history_with_hooks', self.id, self.from_one(point), dof, n, n, []);
    end

    function shares = slip(self, point)
    %SLIP  Shares of the period that each contact slips.
      n = self.reduction.contacts;
      shares = hbvib_mex('branch_slip_fraction', self.id, self.from_one(point), n, n);
    end

    function [motion, force, state] = loop(self, point, contact, n)
    %LOOP  Hysteresis loop of a contact over one period at n times; state 0 sticks, 1 slips, 2 is open.
      if nargin < 4, n = 256; end
      contact = hbvib.internal.zero('contact', contact, self.reduction.contacts);
      [motion, force, state] = hbvib_mex('branch_contact_loop_with_hooks', self.id, self.from_one(point), contact, 0, n, n, n, ...
                                         n, []);
    end

    function info = energy(self, point)
    %ENERGY  Energies of a point and the work of damping and friction per cycle.
      info = hbvib_mex('branch_energy_with_hooks', self.id, self.from_one(point), []);
    end

    function info = summary(self, point, contact)
    %SUMMARY  Work per cycle, shares of slip and separation, ranges of a contact.
      contact = hbvib.internal.zero('contact', contact, self.reduction.contacts);
      info = hbvib_mex('branch_contact_summary_with_hooks', self.id, self.from_one(point), contact, []);
    end

    function info = mode_point(self, point)
    %MODE_POINT  Frequency, damping ratio, energy of a point of a nonlinear mode.
      info = hbvib_mex('branch_mode_point', self.id, self.from_one(point));
    end

    function found = synthesis_peaks(self, model, varargin)
    %SYNTHESIS_PEAKS  Resonances under the forces of a model that the nonlinear mode predicts: omega, amplitude, damping_ratio ...
    %   options  model_damping, force_factor, damping_ratio.
      [~, rest] = hbvib.internal.options('synthesis_peaks', varargin, struct(), true);
      if isempty(fieldnames(rest)), rest = []; end
      [found.omega, found.amplitude, found.log10_amplitude, found.damping_ratio, found.other_mode, found.error, found.flags] = ...
          hbvib.internal.listed('branch_synthesis_peaks_with_hooks', {self.id, model.id, rest}, true, 7);
    end

    function line = plot(self, varargin)
    %PLOT  Draws the curve with its peaks: amplitude over omega; plot(axes, ...) draws into these axes.
      omega = self.omega;
      amplitude = self.amplitude;
      if ~isempty(varargin) && isscalar(varargin{1}) && ishghandle(varargin{1}), axes(varargin{1}); varargin(1) = []; end
      line = plot(omega, amplitude, varargin{:});
      xlabel('omega in rad per time unit');
      ylabel('amplitude');
    end
  end
end
