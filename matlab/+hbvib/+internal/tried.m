function result = tried(law, call)
%TRIED  The result of a law of the caller; of one that failed its error as the field `failure`, which the gateway throws after the call.
  try
    result = law(call);
  catch thrown
    result = struct('failure', struct('message', thrown.message, 'identifier', thrown.identifier));
  end
end
