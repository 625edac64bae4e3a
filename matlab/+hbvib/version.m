function text = version()
%VERSION  The version of the library, such as '0.1.0'.
  text = hbvib_mex('version_string');
end
